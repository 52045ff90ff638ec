// LCP solvers of others, to be measured beside the kernel's.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace slideway::charts {

/// A solver with one problem w - M z = q, w, z >= 0, w'z = 0 of its own, and all the memory that it lets its user keep.
class LcpPeer {
 public:
  explicit LcpPeer(int n);
  LcpPeer(const LcpPeer&) = delete;
  LcpPeer& operator=(const LcpPeer&) = delete;
  virtual ~LcpPeer() = default;
  /// Takes what `m` now holds into a storage of its own, if it has one.
  virtual void place() {}
  /// Whether it says that it has succeeded. z: in, the start, where it takes one; out, as w, its answer.
  virtual bool solve() = 0;

  int n;
  std::vector<double> m;  ///< column by column
  std::vector<double> q, z, w;
};

struct LcpSolver {
  std::string name;
  bool takes_start;  ///< of z
  int most_order;    ///< beyond which it is not asked: its cost is exponential
  std::function<std::unique_ptr<LcpPeer>(int n)> make;
};

/// Siconos' solvers; none where it was not found when this was built.
const std::vector<LcpSolver>& lcp_solvers();
/// The one that stands for all in comparisons.
inline constexpr char lexicolemke[] = "lexicolemke";

/// Runs `body` with the standard output thrown away: some of the solvers print there in every solve.
void in_silence(const std::function<void()>& body);

}  // namespace slideway::charts
