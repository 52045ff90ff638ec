#include "hlcp.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace slideway::oracle {
namespace {

namespace mp = boost::multiprecision;

int sign(const Integer& value) { return value.sign(); }

/// Where the components of a solution or ray are positive and where negative, as bits.
struct Signs {
  std::uint32_t positive = 0, negative = 0;

  friend bool opposed(Signs a, Signs b) { return (a.positive & b.negative) != 0 || (a.negative & b.positive) != 0; }
};

/// Columns of [A+ | A-] are taken one after the other, at most one of each pair, and eliminated without fractions
/// (Bareiss 1968): after m of them, entry (i, j) of level m is the minor of the m pivot rows and row i, and of the m
/// columns taken and column j. So all numbers are integers, and each division is exact.
class Walk {
 public:
  enum class Take { every, any };  ///< of each pair: exactly one column, or at most one

  Walk(const ExactHlcp& problem, Take take) : n_(problem.n), columns_(2 * n_ + 1), take_(take) {
    for (int m = 0; m <= n_; ++m) level_[m].entry.resize(m == 0 ? 0 : problem.rows.size());
    level_[0].entry = problem.rows;
  }

  bool only_w_property = false;  ///< every: only determinants are wanted, and those only while they have one sign
  bool singular = false;         ///< every: some determinant is zero; the walk stops there
  bool w_property = true;
  std::vector<Exact> vertices;  ///< any: all of them; every: the solutions, if no determinant is zero
  std::vector<Signs> vertex_signs, rays;

  void run() { decide(0); }

 private:
  struct Level {
    std::vector<Integer> entry;  ///< rows m..n-1 are in use, and of columns those not yet decided
    int parity = 1;              ///< of the row exchanges so far
    int column = 0;              ///< taken here, by row m of this level
  };

  Integer& at(int m, int i, int j) { return level_[m].entry[static_cast<std::size_t>(i * columns_ + j)]; }
  const Integer& previous_pivot(int m) { return m == 0 ? one_ : at(m - 1, m - 1, level_[m - 1].column); }
  int wanted(int column) const { return column < n_ ? 1 : -1; }

  /// Decides pair k and those after it; m_ columns are taken.
  void decide(int k) {
    if (k == n_) return finish();
    if (take_ == Take::any) decide(k + 1);
    for (const int column : {k, n_ + k}) {
      if (stopped()) return;
      if (!bring_pivot(column)) {
        note_dependence(column);
        continue;
      }
      level_[m_].column = column;
      eliminate(k, column);
      ++m_;
      decide(k + 1);
      --m_;
    }
  }

  bool stopped() const { return take_ == Take::every && (singular || (only_w_property && !w_property)); }

  /// Exchanges rows so that row m has the column's pivot; false if the column depends on those taken.
  bool bring_pivot(int column) {
    for (int i = m_; i < n_; ++i) {
      if (at(m_, i, column).is_zero()) continue;
      if (i != m_) {
        for (int j = 0; j < columns_; ++j) std::swap(at(m_, i, j), at(m_, m_, j));
        level_[m_].parity = -level_[m_].parity;
      }
      return true;
    }
    return false;
  }

  void eliminate(int k, int column) {
    const Integer& pivot = at(m_, m_, column);
    const Integer& divisor = previous_pivot(m_);
    level_[m_ + 1].parity = level_[m_].parity;
    for (int i = m_ + 1; i < n_; ++i) {
      const Integer& factor = at(m_, i, column);
      const auto update = [&](int j) {
        Integer& result = at(m_ + 1, i, j);
        result = pivot * at(m_, i, j);
        if (!factor.is_zero()) result -= factor * at(m_, m_, j);
        if (m_ > 0) result /= divisor;
      };
      for (int j = k + 1; j < n_; ++j) {
        update(j);
        update(n_ + j);
      }
      update(2 * n_);
    }
  }

  /// The coefficients of column j in the columns taken, times the minor D of these (Cramer), last first; D is the last
  /// pivot. Stops, and is false, at the first of which accept(index, sign) is false.
  template <class Accept>
  bool coefficients(int j, Accept accept) {
    const Integer& minor = previous_pivot(m_);
    const int minor_sign = sign(minor);
    for (int i = m_ - 1; i >= 0; --i) {
      Integer sum = minor * at(i, i, j);
      for (int l = i + 1; l < m_; ++l) sum -= at(i, i, level_[l].column) * cramer_[l];
      cramer_[i] = sum / at(i, i, level_[i].column);
      if (!accept(i, sign(cramer_[i]) * minor_sign)) return false;
    }
    return true;
  }

  void note_dependence(int column) {
    singular = true;
    w_property = false;
    if (take_ == Take::every) return;
    // c - sum of coefficient times column = 0, every one with its own sign and not 0, else the support is not least.
    Signs signs;
    const auto accept = [&](int i, int s) { return -s * wanted(column) == wanted(level_[i].column); };
    if (!coefficients(column, accept)) return;
    for (int i = 0; i < m_; ++i) mark(signs, level_[i].column);
    mark(signs, column);
    rays.push_back(signs);
  }

  void mark(Signs& signs, int column) const {
    (column < n_ ? signs.positive : signs.negative) |= std::uint32_t{1} << (column % n_);
  }

  /// All pairs are decided.
  void finish() {
    if (take_ == Take::every) note_determinant();
    if (only_w_property) return;
    for (int i = m_; i < n_; ++i)
      if (!at(m_, i, 2 * n_).is_zero()) return;
    // One support for each vertex: no zeros; of patterns, zeros in columns of A+.
    const auto accept = [&](int i, int s) {
      const int column = level_[i].column;
      return s == wanted(column) || (s == 0 && take_ == Take::every && column < n_);
    };
    if (!coefficients(2 * n_, accept)) return;
    Exact x(static_cast<std::size_t>(n_));
    Signs signs;
    const mp::cpp_int minor(previous_pivot(m_));
    for (int i = 0; i < m_; ++i) {
      const int column = level_[i].column;
      x[static_cast<std::size_t>(column % n_)] =
          Rational(mp::cpp_int(minor < 0 ? -cramer_[i] : cramer_[i]), abs(minor));
      mark(signs, column);
    }
    vertices.push_back(std::move(x));
    vertex_signs.push_back(signs);
  }

  void note_determinant() {
    const int s = sign(previous_pivot(n_)) * level_[n_].parity;
    if (first_sign_ == 0) first_sign_ = s;
    if (s != first_sign_) w_property = false;
  }

  const int n_, columns_;
  const Take take_;
  const Integer one_ = 1;
  std::array<Level, exact_max_order + 1> level_;
  std::array<Integer, exact_max_order> cramer_;
  int m_ = 0;
  int first_sign_ = 0;
};

void require_order(const ExactHlcp& problem) {
  if (problem.n < 0 || problem.n > exact_max_order)
    throw std::invalid_argument("exact solutions are found for orders up to " + std::to_string(exact_max_order));
}

}  // namespace

Count ExactAnswer::count() const {
  if (!continuum.empty()) return Count::continuum;
  return isolated.empty() ? Count::none : isolated.size() == 1 ? Count::one : Count::several;
}

ExactAnswer solve(const ExactHlcp& problem) {
  require_order(problem);
  Walk patterns(problem, Walk::Take::every);
  patterns.run();
  if (!patterns.singular) return {patterns.w_property, std::move(patterns.vertices), {}};
  Walk supports(problem, Walk::Take::any);
  supports.run();
  ExactAnswer answer;
  for (std::size_t v = 0; v < supports.vertices.size(); ++v) {
    const Signs signs = supports.vertex_signs[v];
    const auto joined = [&](Signs other) { return !opposed(signs, other); };
    const auto vertices = std::count_if(supports.vertex_signs.begin(), supports.vertex_signs.end(), joined);
    const bool alone = vertices == 1 && std::none_of(supports.rays.begin(), supports.rays.end(), joined);
    (alone ? answer.isolated : answer.continuum).push_back(std::move(supports.vertices[v]));
  }
  return answer;
}

bool has_w_property(const ExactHlcp& problem) {
  require_order(problem);
  Walk patterns(problem, Walk::Take::every);
  patterns.only_w_property = true;
  patterns.run();
  return patterns.w_property;
}

}  // namespace slideway::oracle
