// The same runs in other units, each judged by the run in SI units: units that are powers of two (of mass, of four: its
// root is taken) must give every bit of it, others its numbers to rounding.
#include <cmath>
#include <stdexcept>

#include "scaled.hpp"

namespace slideway::charts {
namespace {

struct Case {
  std::string scene;
  Method method;
  double dt;
  long steps;
};
// With a stick and a break-away, a drive and a fast turn.
const Case cases[] = {{"belt", Method::rk4_located, 0.05, 220},
                      {"crank_rocker", Method::dop853_located, 0.01, 50},
                      {"slider_crank", Method::rk4, 1e-5, 100},
                      {"crank_rocker_free", Method::moreau, 1e-3, 50}};

double power_of(double base, double x) { return std::pow(base, std::round(std::log(x) / std::log(base))); }

/// `bits`: not to be told apart. Else: of each of the last numbers that the runs have, to 1e-9 of the largest of its
/// kind; the roundings of some hundred steps are far below.
Cell judge(const RunScene& scene, const Case& of, const Units& units, bool bits) {
  io::RunStepper plain(scene), other(in_units(scene, units));
  plain.method = other.method = of.method;
  const ShortRun truth = short_run(plain, plain.start(), of.dt, of.steps);
  if (truth.status != Status::ok) throw std::runtime_error(of.scene + ": the run in SI units is refused");
  const ShortRun run = short_run(other, other.start(), of.dt * units.s, of.steps);
  if (truth.status != run.status || truth.steps != run.steps) {
    return run.status == Status::ok ? Cell::wrong : Cell::refused_wrongly;
  }
  const std::vector<double> a = in_si(plain, truth.state, {1, 1, 1}), b = in_si(other, run.state, units);
  if (a.size() != b.size()) return b.empty() ? Cell::refused_wrongly : Cell::wrong;
  if (bits) return a == b ? Cell::right : Cell::wrong;
  double error = 0, size = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    error = std::fmax(error, std::fabs(a[k] - b[k]));
    size = std::fmax(size, std::fabs(a[k]));
  }
  return error <= 1e-9 * size ? Cell::right : Cell::wrong;
}

Cell worse(Cell a, Cell b) { return a > b ? a : b; }

void draw(const std::string& name, const std::string& other, const AtlasOptions& options,
          const std::function<Units(double, double)>& units, AtlasMap& map) {
  const int n = options.quick ? 5 : 19;
  // A cell's middle is a power of ten.
  const double half = options.quick ? std::pow(10, 2.25) : std::sqrt(10.0);
  const Grid grid{{"length unit, 1 / m", 1e-9 / half, 1e9 * half, true}, {other, 1e-9 / half, 1e9 * half, true}, n, n};
  std::vector<RunScene> scenes;
  for (const Case& one : cases) scenes.push_back(options.scene(one.scene));
  std::vector<Cell> decimal, binary;
  int done = 0;
  judge_cells(grid, [&](double x, double y) {
    options.progress(done++ / static_cast<double>(n * n), name);
    Cell to_rounding = Cell::right, to_the_bit = Cell::right;
    const Units tens = units(x, y), twos{power_of(2, tens.m), power_of(4, tens.kg), power_of(2, tens.s)};
    for (std::size_t k = 0; k < scenes.size(); ++k) {
      to_rounding = worse(to_rounding, judge(scenes[k], cases[k], tens, false));
      to_the_bit = worse(to_the_bit, judge(scenes[k], cases[k], twos, true));
    }
    decimal.push_back(to_rounding);
    binary.push_back(to_the_bit);
    return Cell::right;
  });
  add_cells(map, {name + "_decimal", "slideway, four scenes to rounding", "The same in other units"}, grid, decimal);
  add_cells(map, {name + "_binary", "slideway, four scenes to the bit", "The same in units of powers of two"}, grid,
            binary);
}

}  // namespace

AtlasMap draw_units(const AtlasOptions& options) {
  AtlasMap map = begin_map("units");
  draw(
      "mass", "mass unit, 1 / kg", options,
      [](double x, double y) {
        return Units{x, y, 1};
      },
      map);
  draw(
      "time", "time unit, 1 / s", options,
      [](double x, double y) {
        return Units{x, 1, y};
      },
      map);
  return map;
}

}  // namespace slideway::charts
