#include "families.hpp"

#include <cmath>
#include <random>
#include <slideway/io/stepper.hpp>
#include <stdexcept>

#include "../../hlcp_chain.hpp"

namespace slideway::charts {
namespace {

using properties::Choices;
using properties::HlcpKind;
using Bytes = std::vector<std::uint8_t>;

/// Bytes for draw_hlcp(..., n): the first asks for the order n, the second is `second`, the rest is random; for `plain`
/// zero, the simplest choice.
Bytes bytes_for(int n, int second, bool plain, std::mt19937_64& random) {
  Bytes bytes(static_cast<std::size_t>(4 * n * n + 16));
  for (std::uint8_t& byte : bytes) byte = plain ? 0 : static_cast<std::uint8_t>(random());
  bytes[0] = static_cast<std::uint8_t>(n - 1);
  bytes[1] = static_cast<std::uint8_t>(second);
  return bytes;
}

HlcpCase drawn(HlcpKind kind, int n, const Bytes& bytes) {
  Choices choices(bytes);
  return draw_hlcp(choices, kind, n);
}

template <int N>
std::vector<HlcpCase> chain_of(int count) {
  std::vector<HlcpCase> all;
  for (const auto& problem : chain::problems<N>()) {
    if (static_cast<int>(all.size()) == count) break;
    HlcpCase one{N, {}};
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j < N; ++j) {
        one.data.plus[i][j] = problem.hlcp.plus[i][j];
        one.data.minus[i][j] = problem.hlcp.minus[i][j];
      }
      one.data.b[i] = problem.hlcp.b[i];
    }
    all.push_back(one);
  }
  return all;
}

std::vector<HlcpCase> chains(int n, int count) {
  switch (n) {
    case 2:
      return chain_of<2>(count);
    case 4:
      return chain_of<4>(count);
    case 8:
      return chain_of<8>(count);
    case 16:
      return chain_of<16>(count);
    case 32:
      return chain_of<32>(count);
    default:
      throw std::logic_error("no chain of this order");
  }
}

std::vector<HlcpCase> dense(int n, int count) {
  std::mt19937_64 random(1);
  std::vector<HlcpCase> all;
  while (static_cast<int>(all.size()) < count)
    all.push_back(drawn(HlcpKind::friction, n, bytes_for(n, static_cast<int>(random() % 256), false, random)));
  return all;
}

/// Those of the kind `lcp` whose diagonal was raised.
std::vector<HlcpCase> dominant(int n, int count) {
  std::mt19937_64 random(2);
  std::vector<HlcpCase> all;
  while (static_cast<int>(all.size()) < count) {
    HlcpCase one = drawn(HlcpKind::lcp, n, bytes_for(n, static_cast<int>(random() % 256), false, random));
    if (one.data.minus[0][0] >= 16 * n) all.push_back(one);
  }
  return all;
}

// ---- from the steps of shipped scenes

using Size = io::RunSize;

/// The problem of part 0 at a state, all guides slipping; its order.
int problem_at(const io::RunStepper& stepper, const io::RunStepper::State& state, HlcpCase& one) {
  const auto& source = stepper.source;
  const Inputs<Size> inputs = {};
  const Moment<Size> at{state.time(), 0, state.q, state.v, inputs, Aim::decide, false};
  const Solving solving{{source.scene.alpha, source.scene.beta}, {}};
  Work<Size> w;
  Reaction<Size> r;
  place(source, at, solving, w, r);
  signed char mode[Size::guides] = {};
  for (int g = 0; g < source.scene.guides; ++g) mode[g] = r.slip[g] < 0 ? -1 : 1;
  apply_forces(source, w.kinematics, inputs, 0, w.dynamics);
  apply_steady_friction(source, mode, w.friction, w.dynamics);
  gather(source, w.kinematics, w.dynamics);
  Problem<RunTime<Size>> problem;
  if (!factor_mass(source, w.kinematics, state.q, state.v, w.dynamics) ||
      !assemble(source, w.kinematics, w.dynamics, solving.gains, mode, w.friction, r) ||
      !assemble_part(source, w.kinematics, w.dynamics, 0, w.friction, problem))
    throw std::runtime_error("a shipped scene has no problem to solve");
  const int n = source.tables.first_row[1];
  one = {n, {}};
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      one.data.plus[i][j] = problem.plus[i][j];
      one.data.minus[i][j] = problem.minus[i][j];
    }
    one.data.b[i] = problem.b[i];
  }
  return n;
}

/// slider_crank, and the engines with n / 2 cylinders, every 3 ms of the run.
std::vector<HlcpCase> mechanisms(int n, int count) {
  const std::string name = n == 2 ? "slider_crank" : "v_engine_" + std::to_string(n / 2);
  const io::Reading reading = io::read_scene(SLIDEWAY_SOURCE_DIR "/scenes/" + name + ".toml");
  if (!reading.scene) throw std::runtime_error(to_string(reading.defects.at(0)));
  const io::RunStepper stepper(reading.scene->scene);
  auto state = stepper.start();
  std::vector<HlcpCase> all(static_cast<std::size_t>(count));
  for (HlcpCase& one : all) {
    if (problem_at(stepper, state, one) != n) throw std::logic_error(name + ": another order was expected");
    for (int k = 0; k < 30; ++k) {
      if (stepper.step(state, 1e-4).status != Status::ok) throw std::runtime_error(name + ": a step failed");
    }
  }
  return all;
}

// ---- from the literature: which = 0 Murty's, 1 its transpose, 2 Fathi's, 3 Kostreva's matrix of draw_hlcp()

/// q = -1, then q of dyadic numbers and -1.
template <int Which>
std::vector<HlcpCase> textbook(int n, int count) {
  std::mt19937_64 random(3);
  std::vector<HlcpCase> all;
  while (static_cast<int>(all.size()) < count)
    all.push_back(drawn(HlcpKind::textbook, n, bytes_for(n, Which, all.empty(), random)));
  return all;
}

/// Kostreva's matrix of order 3 in blocks, and 1 for the rest: of an even order it is no P-matrix.
std::vector<HlcpCase> cycles(int n, int count) {
  std::mt19937_64 random(4);
  std::vector<HlcpCase> all;
  while (static_cast<int>(all.size()) < count) {
    HlcpCase one{n, {}};
    for (int first = 0; first < n;) {
      const int order = n - first >= 3 ? 3 : 1;
      const HlcpCase block = drawn(HlcpKind::textbook, order, bytes_for(order, 3, all.empty(), random));
      for (int i = 0; i < order; ++i) {
        for (int j = 0; j < order; ++j) {
          one.data.plus[first + i][first + j] = block.data.plus[i][j];
          one.data.minus[first + i][first + j] = block.data.minus[i][j];
        }
        one.data.b[first + i] = block.data.b[i];
      }
      first += order;
    }
    all.push_back(one);
  }
  return all;
}

}  // namespace

const std::vector<HlcpFamily>& kind_families() {
  static const std::vector<HlcpFamily> families = {
      {"mechanism", "from steps of slider_crank and of the v_engines with 2, 4, 8 and 16 cylinders", false, mechanisms},
      {"chain", "contacts along a chain of bodies", false, chains},
      {"dense", "S = N N' + D, weak S*, dyadic numbers", false, dense},
      {"dominant", "LCPs with a dominant diagonal, dyadic numbers", true, dominant},
  };
  return families;
}

const std::vector<HlcpFamily>& hard_families() {
  static const std::vector<HlcpFamily> families = {
      {"Murty", "lower triangular: 1 on the diagonal, 2 below", true, textbook<0>},
      {"Murty transposed", "upper triangular: 1 on the diagonal, 2 above", true, textbook<1>},
      {"Fathi", "M M' of Murty's M", true, textbook<2>},
      {"cyclic", "Kostreva's matrix of order 3 in blocks", true, cycles},
  };
  return families;
}

}  // namespace slideway::charts
