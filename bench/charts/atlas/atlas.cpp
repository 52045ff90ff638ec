#include "atlas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace slideway::charts {
namespace {

constexpr const char* cell_names[cell_kinds] = {
    "right", "refused rightly", "refused a step late", "off, events counted", "refused wrongly", "wrong in silence"};
constexpr const char* cell_keys[cell_kinds] = {"right",  "refused_rightly", "refused_late",
                                               "warned", "refused_wrongly", "wrong_in_silence"};
const Category cell_shades[cell_kinds] = {{{}, 0, 0.28}, {{}, 4, 0.45}, {{}, 4, 1},
                                          {{}, 5, 0.9},  {{}, 3, 0.9},  {{}, 1, 1}};
constexpr char cell_letters[] = "rslcfw";  ///< of a row in the document

double middle(const Axis& axis, double part) {
  if (axis.logarithmic) return axis.from * std::pow(axis.to / axis.from, part);
  return axis.from + (axis.to - axis.from) * part;
}

io::Json axis_document(const Axis& axis, int cells) {
  return {
      {"label", axis.label}, {"from", axis.from}, {"to", axis.to}, {"logarithmic", axis.logarithmic}, {"cells", cells}};
}

}  // namespace

const std::vector<AtlasEntry>& atlas() {
  static const std::vector<AtlasEntry> entries = {{"baumgarte", draw_baumgarte},
                                                  {"friction", draw_friction},
                                                  {"pole", draw_pole},
                                                  {"stick_slip", draw_stick_slip},
                                                  {"mass_ratio", draw_mass_ratio},
                                                  {"singular", draw_singular},
                                                  {"long_run", draw_long_run},
                                                  {"units", draw_units}};
  return entries;
}

double Grid::across(int column) const { return middle(x, (column + 0.5) / columns); }
double Grid::up(int row) const { return middle(y, (row + 0.5) / rows); }

AtlasMap begin_map(const std::string& name) {
  return {name, {}, {{"format", io::json_format}, {"atlas", name}, {"maps", io::Json::array()}}};
}

std::vector<Cell> judge_cells(const Grid& grid, const std::function<Cell(double, double)>& judge) {
  std::vector<Cell> cells;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) cells.push_back(judge(grid.across(column), grid.up(row)));
  }
  return cells;
}

void add_cells(AtlasMap& map, const CellFigure& figure, const Grid& grid, const std::vector<Cell>& cells) {
  Map drawing{figure.title, "", grid.x, grid.y, grid.columns, grid.rows, {}, {}, figure.lines, figure.notes};
  io::Json counts = io::Json::object();
  int place[cell_kinds];  // in the legend
  for (int kind = 0; kind < cell_kinds; ++kind) {
    const auto count = std::count(cells.begin(), cells.end(), static_cast<Cell>(kind));
    counts[cell_keys[kind]] = count;
    place[kind] = static_cast<int>(drawing.categories.size());
    const bool rare = static_cast<Cell>(kind) == Cell::refused_late || static_cast<Cell>(kind) == Cell::warned;
    if (count == 0 && rare) continue;
    Category category = cell_shades[kind];
    category.name = fmt::format("{}: {}", cell_names[kind], count);
    drawing.categories.push_back(category);
  }
  drawing.subtitle = fmt::format("{}: {} of {} cases wrong in silence", figure.method,
                                 std::count(cells.begin(), cells.end(), Cell::wrong), cells.size());
  io::Json rows = io::Json::array();
  for (int row = 0; row < grid.rows; ++row) {
    std::string letters;
    for (int column = 0; column < grid.columns; ++column) {
      const Cell cell = cells[static_cast<std::size_t>(row * grid.columns + column)];
      drawing.cells.push_back(place[static_cast<int>(cell)]);
      letters += cell_letters[static_cast<int>(cell)];
    }
    rows.push_back(letters);
  }
  map.document["maps"].push_back({{"name", figure.name},
                                  {"method", figure.method},
                                  {"title", figure.title},
                                  {"x", axis_document(grid.x, grid.columns)},
                                  {"y", axis_document(grid.y, grid.rows)},
                                  {"counts", counts},
                                  {"rows_from_below", rows}});
  map.figures.push_back({map.name + "_" + figure.name, std::move(drawing)});
}

std::vector<double> decades(int from, int to, int a_decade) {
  std::vector<double> values;
  for (int k = from * a_decade; k <= to * a_decade; ++k)
    values.push_back(std::pow(10, static_cast<double>(k) / a_decade));
  return values;
}

}  // namespace slideway::charts
