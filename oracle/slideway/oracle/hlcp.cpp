#include "hlcp.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace slideway::oracle {
namespace {

namespace mp = boost::multiprecision;

/// For small data: no heap, an instruction or two an operation.
using Short = __int128;

template <class Number>
int sign(const Number& value) {
  return (value > 0) - (value < 0);
}

/// Where the components of a solution or ray are positive and where negative, as bits.
struct Signs {
  std::uint32_t positive = 0, negative = 0;

  friend bool opposed(Signs a, Signs b) { return (a.positive & b.negative) != 0 || (a.negative & b.positive) != 0; }
};

/// Columns of [A+ | A-] are taken one after the other, at most one of each pair, and eliminated without fractions
/// (Bareiss 1968): after m of them, entry (i, j) of level m is the minor of the m pivot rows and row i, and of the m
/// columns taken and column j. So all numbers are integers, and each division is exact.
template <class Number>
class Walk {
 public:
  enum class Take { every, any };  ///< of each pair: exactly one column, or at most one

  Walk(const ExactHlcp& problem, Take take) : n_(problem.n), columns_(2 * n_ + 1), take_(take) {
    entry_.resize((static_cast<std::size_t>(n_) + 1) * problem.rows.size());
    std::transform(problem.rows.begin(), problem.rows.end(), entry_.begin(),
                   [](const Integer& value) { return static_cast<Number>(value); });
  }

  bool only_counts = false;      ///< vertices are left empty
  bool only_w_property = false;  ///< every: only determinants are wanted, and those only while they have one sign
  bool singular = false;         ///< every: some determinant is zero; the walk stops there
  bool w_property = true;
  std::vector<Exact> vertices;  ///< any: all of them; every: the solutions, if no determinant is zero
  std::vector<Signs> vertex_signs, rays;

  void run() { decide(0); }

 private:
  struct Level {
    int parity = 1;  ///< of the row exchanges so far
    int column = 0;  ///< taken here, by row m of this level
  };

  Number& at(int m, int i, int j) { return entry_[static_cast<std::size_t>((m * n_ + i) * columns_ + j)]; }
  const Number& previous_pivot(int m) { return m == 0 ? one_ : at(m - 1, m - 1, level_[m - 1].column); }
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
      if (at(m_, i, column) == 0) continue;
      if (i != m_) {
        for (int j = 0; j < columns_; ++j) std::swap(at(m_, i, j), at(m_, m_, j));
        level_[m_].parity = -level_[m_].parity;
      }
      return true;
    }
    return false;
  }

  void eliminate(int k, int column) {
    const Number& pivot = at(m_, m_, column);
    const Number& divisor = previous_pivot(m_);
    level_[m_ + 1].parity = level_[m_].parity;
    for (int i = m_ + 1; i < n_; ++i) {
      const Number& factor = at(m_, i, column);
      const auto update = [&](int j) {
        Number& result = at(m_ + 1, i, j);
        result = pivot * at(m_, i, j);
        if (factor != 0) result -= factor * at(m_, m_, j);
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
    const Number& minor = previous_pivot(m_);
    const int minor_sign = sign(minor);
    for (int i = m_ - 1; i >= 0; --i) {
      Number sum = minor * at(i, i, j);
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
      if (at(m_, i, 2 * n_) != 0) return;
    // One support for each vertex: no zeros; of patterns, zeros in columns of A+.
    const auto accept = [&](int i, int s) {
      const int column = level_[i].column;
      return s == wanted(column) || (s == 0 && take_ == Take::every && column < n_);
    };
    if (!coefficients(2 * n_, accept)) return;
    Signs signs;
    for (int i = 0; i < m_; ++i) mark(signs, level_[i].column);
    vertex_signs.push_back(signs);
    vertices.push_back(only_counts ? Exact() : vertex());
  }

  /// From the coefficients of b.
  Exact vertex() {
    Exact x(static_cast<std::size_t>(n_));
    const mp::cpp_int minor(previous_pivot(m_));
    for (int i = 0; i < m_; ++i) {
      x[static_cast<std::size_t>(level_[i].column % n_)] =
          Rational(mp::cpp_int(minor < 0 ? Number(-cramer_[i]) : cramer_[i]), abs(minor));
    }
    return x;
  }

  void note_determinant() {
    const int s = sign(previous_pivot(n_)) * level_[n_].parity;
    if (first_sign_ == 0) first_sign_ = s;
    if (s != first_sign_) w_property = false;
  }

  const int n_, columns_;
  const Take take_;
  const Number one_ = 1;
  std::vector<Number> entry_;  ///< of level m, rows m..n-1 are in use, and of columns those not yet decided
  std::array<Level, exact_max_order + 1> level_;
  std::array<Number, exact_max_order> cramer_;
  int m_ = 0;
  int first_sign_ = 0;
};

void require_order(const ExactHlcp& problem) {
  if (problem.n < 0 || problem.n > exact_max_order)
    throw std::invalid_argument("exact solutions are found for orders up to " + std::to_string(exact_max_order));
}

int bits_of(unsigned value) {
  int bits = 0;
  for (; value != 0; value >>= 1) ++bits;
  return bits;
}

/// Whether no number of a Walk exceeds 127 bits. The minors are at most n! times the largest entry of each row, the
/// largest sums are of n + 1 products of two of these.
bool is_short(const ExactHlcp& problem) {
  int minor = 0;
  const auto columns = 2 * static_cast<std::size_t>(problem.n) + 1;
  for (std::size_t i = 0; i < problem.rows.size(); i += columns) {
    int most = 0;
    for (std::size_t j = i; j < i + columns; ++j) {
      const Integer& value = problem.rows[j];
      if (!value.is_zero()) most = std::max(most, 1 + static_cast<int>(msb(value < 0 ? -value : value)));
    }
    minor += most;
  }
  for (int k = 2; k <= problem.n; ++k) minor += bits_of(static_cast<unsigned>(k - 1));
  return 2 * minor + bits_of(static_cast<unsigned>(problem.n)) <= 127;
}

template <class Number>
ExactAnswer solve_in(const ExactHlcp& problem, Want want) {
  Walk<Number> patterns(problem, Walk<Number>::Take::every);
  patterns.only_counts = want == Want::counts;
  patterns.run();
  if (!patterns.singular) return {patterns.w_property, std::move(patterns.vertices), {}};
  Walk<Number> supports(problem, Walk<Number>::Take::any);
  supports.only_counts = want == Want::counts;
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

}  // namespace

Count ExactAnswer::count() const {
  if (!continuum.empty()) return Count::continuum;
  return isolated.empty() ? Count::none : isolated.size() == 1 ? Count::one : Count::several;
}

ExactAnswer solve(const ExactHlcp& problem, Want want) {
  require_order(problem);
  return is_short(problem) ? solve_in<Short>(problem, want) : solve_in<Integer>(problem, want);
}

bool has_w_property(const ExactHlcp& problem) {
  require_order(problem);
  Walk<Integer> patterns(problem, Walk<Integer>::Take::every);
  patterns.only_w_property = true;
  patterns.run();
  return patterns.w_property;
}

}  // namespace slideway::oracle
