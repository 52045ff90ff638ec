// Gauss's elimination for the sparse matrices of mechanisms, in any number type: what a row or column does not have
// costs nothing, and the pivots can be seen, which tell whether rank is lost.
#pragma once

#include <cmath>
#include <slideway/oracle/real.hpp>
#include <utility>
#include <vector>

namespace slideway::oracle {

template <class T>
class Elimination {
 public:
  using Rows = std::vector<std::vector<T>>;

  /// Factors a square matrix, column by column. Of the rows whose entry is at least a tenth of the largest, the one
  /// with the fewest entries is the pivot's: a tenth costs at most a digit a step, and keeps others empty.
  void compute(Rows matrix) {
    const std::size_t n = size_ = matrix.size();
    steps_.clear();
    std::vector<bool> done(n, false);
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t pivot = choose(matrix, done, k);
      if (pivot == n) return;
      done[pivot] = true;
      Step step{pivot, matrix[pivot][k], {}, {}};
      for (std::size_t j = k + 1; j < n; ++j) {
        if (matrix[pivot][j] != 0) step.right.emplace_back(j, matrix[pivot][j]);
      }
      for (std::size_t i = 0; i < n; ++i) {
        if (done[i] || matrix[i][k] == 0) continue;
        const T factor = matrix[i][k] / step.pivot;
        step.below.emplace_back(i, factor);
        for (const auto& [j, value] : step.right) matrix[i][j] -= factor * value;
      }
      steps_.push_back(std::move(step));
    }
  }

  /// A pivot that is rounding beside the largest: rows and columns of mechanisms in SI units differ by far less.
  bool lost_rank() const {
    using std::abs;
    if (steps_.size() < size_) return true;
    T least(0), most(0);
    for (const Step& step : steps_) {
      const T size = abs(step.pivot);
      least = &step == &steps_.front() || size < least ? size : least;
      most = size > most ? size : most;
    }
    return size_ > 0 && !(least > zero_tolerance<T>() * most);
  }

  /// Requires a matrix of full rank.
  std::vector<T> solve(std::vector<T> b) const {
    for (const Step& step : steps_) {
      const T& y = b[step.row];
      if (y == 0) continue;
      for (const auto& [i, factor] : step.below) b[i] -= factor * y;
    }
    std::vector<T> x(size_);
    for (std::size_t k = size_; k-- > 0;) {
      const Step& step = steps_[k];
      T sum = b[step.row];
      for (const auto& [j, value] : step.right) sum -= value * x[j];
      x[k] = sum / step.pivot;
    }
    return x;
  }

 private:
  struct Step {
    std::size_t row;
    T pivot;
    std::vector<std::pair<std::size_t, T>> right, below;  ///< of the pivot's row; factors of the rows that it clears
  };

  /// n if the column is empty.
  static std::size_t choose(const Rows& matrix, const std::vector<bool>& done, std::size_t k) {
    using std::abs;
    const std::size_t n = matrix.size();
    T most(0);
    for (std::size_t i = 0; i < n; ++i) {
      if (!done[i] && abs(matrix[i][k]) > most) most = abs(matrix[i][k]);
    }
    std::size_t best = n, fewest = n + 1;
    for (std::size_t i = 0; i < n && most > 0; ++i) {
      if (done[i] || 10 * abs(matrix[i][k]) < most) continue;
      std::size_t entries = 0;
      for (std::size_t j = k; j < n; ++j) entries += matrix[i][j] != 0 ? 1 : 0;
      if (entries < fewest) {
        fewest = entries;
        best = i;
      }
    }
    return best;
  }

  std::size_t size_ = 0;
  std::vector<Step> steps_;
};

}  // namespace slideway::oracle
