// The shortest vector that satisfies linear inequalities: which of many admissible sets of stiction forces is handed
// out.
#pragma once

#include <cmath>

namespace slideway {

/// min |x| with G x >= h, by Lawson and Hanson's way (Solving Least Squares Problems, 1974, ch. 23): with E = [G'; h']
/// and f = (0, ..., 0, 1), non-negative least squares min |E y - f|, y >= 0, has the residual r = f - E y; then
/// x_j = -r_j / r_d, and no x exists iff r = 0.
template <int Rows, int Dimension>
struct LeastNorm {
  static constexpr int n = Dimension + 1;
  int rows = 0, dimension = 0;
  double G[Rows][Dimension], h[Rows];
  double x[Dimension];

  /// Requires rows of about unit length in (G, h), and x of about unit length: r_d = 1 / (1 + |x|^2). Adds a row.
  void require(const double* g, double least) noexcept {
    for (int j = 0; j < dimension; ++j) G[rows][j] = g[j];
    h[rows++] = least;
  }

  /// False if the inequalities contradict each other. At most `rows` columns enter, each pass drops one or ends: capped
  /// at 3 rows passes, which no case tried has come near. O(rows dimension^2) each.
  bool solve() noexcept {
    double y[Rows] = {}, r[n];
    passive_ = 0;
    for (int pass = 0; pass < 3 * rows + 3; ++pass) {
      residual(y, r);
      const int entering = steepest(r);
      if (entering < 0) break;
      set_[passive_++] = entering;
      for (int drop = 0; drop <= dimension + 1; ++drop) {
        double z[n];
        fit(z);
        double step = 1;
        for (int k = 0; k < passive_; ++k) {
          if (z[k] <= 0) step = std::fmin(step, y[set_[k]] / (y[set_[k]] - z[k] + tiny));
        }
        for (int k = 0; k < passive_; ++k) y[set_[k]] += step * (z[k] - y[set_[k]]);
        if (step == 1) break;
        release(y, z);
      }
    }
    residual(y, r);
    // An x of 2^18 times its unit is beyond what is asked for; without an x, r is of the size of roundings.
    if (!(r[dimension] > 0x1p-36)) return false;
    for (int j = 0; j < dimension; ++j) x[j] = -r[j] / r[dimension] + 0.0;
    return true;
  }

 private:
  static constexpr double tiny = 0x1p-1022;
  int set_[Rows + 1], passive_ = 0;
  double q_[n][n];  ///< orthonormal columns of the passive set

  double entry(int i, int row) const noexcept { return i < dimension ? G[row][i] : h[row]; }

  void residual(const double* y, double* r) const noexcept {
    for (int i = 0; i <= dimension; ++i) {
      r[i] = i == dimension ? 1 : 0;
      for (int k = 0; k < passive_; ++k) r[i] -= entry(i, set_[k]) * y[set_[k]];
    }
  }

  bool is_passive(int row) const noexcept {
    bool found = false;
    for (int k = 0; k < passive_; ++k) found = found || set_[k] == row;
    return found;
  }

  /// The row whose column makes the smallest angle with the residual; none once all are at right angles to rounding, or
  /// the passive columns span the space.
  int steepest(const double* r) const noexcept {
    int best = -1;
    double most = 0x1p-40;
    for (int row = 0; row < rows && passive_ <= dimension; ++row) {
      double along = 0;
      for (int i = 0; i <= dimension; ++i) along += entry(i, row) * r[i];
      if (along > most && !is_passive(row)) {
        most = along;
        best = row;
      }
    }
    return best;
  }

  /// z = the coefficients of the passive columns that come nearest to f. Gram and Schmidt, and back.
  void fit(double* z) noexcept {
    double R[n][n] = {}, b[n];
    for (int k = 0; k < passive_; ++k) {
      double column[n];
      for (int i = 0; i <= dimension; ++i) column[i] = entry(i, set_[k]);
      for (int twice = 0; twice < 2; ++twice) {
        for (int l = 0; l < k; ++l) {
          double part = 0;
          for (int i = 0; i <= dimension; ++i) part += q_[l][i] * column[i];
          R[l][k] += part;
          for (int i = 0; i <= dimension; ++i) column[i] -= part * q_[l][i];
        }
      }
      double length = 0;
      for (int i = 0; i <= dimension; ++i) length += column[i] * column[i];
      R[k][k] = std::sqrt(length) + tiny;
      for (int i = 0; i <= dimension; ++i) q_[k][i] = column[i] / R[k][k];
      b[k] = q_[k][dimension];
    }
    for (int k = passive_ - 1; k >= 0; --k) {
      z[k] = b[k];
      for (int l = k + 1; l < passive_; ++l) z[k] -= R[k][l] * z[l];
      z[k] /= R[k][k];
    }
  }

  /// Takes out of the passive set what the last step has brought to zero.
  void release(double* y, const double* z) noexcept {
    int kept = 0;
    for (int k = 0; k < passive_; ++k) {
      const int row = set_[k];
      if (z[k] <= 0 && y[row] <= 0x1p-50) {
        y[row] = 0;
      } else {
        set_[kept++] = row;
      }
    }
    passive_ = kept;
  }
};

}  // namespace slideway
