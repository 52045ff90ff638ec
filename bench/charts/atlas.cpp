#include "atlas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace slideway::charts {
namespace {

constexpr const char* cell_names[cell_kinds] = {"right", "refused rightly", "refused wrongly", "wrong in silence"};
constexpr const char* cell_keys[cell_kinds] = {"right", "refused_rightly", "refused_wrongly", "wrong_in_silence"};
constexpr char cell_letters[] = "rsfw";  ///< of a row in the document

double middle(const Axis& axis, double part) {
  if (axis.logarithmic) return axis.from * std::pow(axis.to / axis.from, part);
  return axis.from + (axis.to - axis.from) * part;
}

std::vector<Category> categories() {
  return {{cell_names[0], 0, 0.28}, {cell_names[1], 4, 0.55}, {cell_names[2], 3, 0.9}, {cell_names[3], 1, 1}};
}

io::Json axis_document(const Axis& axis, int cells) {
  return {
      {"label", axis.label}, {"from", axis.from}, {"to", axis.to}, {"logarithmic", axis.logarithmic}, {"cells", cells}};
}

}  // namespace

const std::vector<AtlasEntry>& atlas() {
  static const std::vector<AtlasEntry> entries = {{"friction", draw_friction}};
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
  Map drawing{figure.title, "", grid.x, grid.y, grid.columns, grid.rows, {}, categories(), figure.lines, figure.notes};
  io::Json counts = io::Json::object();
  for (int kind = 0; kind < cell_kinds; ++kind) {
    const auto count = std::count(cells.begin(), cells.end(), static_cast<Cell>(kind));
    counts[cell_keys[kind]] = count;
    drawing.categories[static_cast<std::size_t>(kind)].name += fmt::format(": {}", count);
  }
  drawing.subtitle = fmt::format("{}: {} of {} cases wrong in silence", figure.method,
                                 counts[cell_keys[cell_kinds - 1]].get<long>(), cells.size());
  io::Json rows = io::Json::array();
  for (int row = 0; row < grid.rows; ++row) {
    std::string letters;
    for (int column = 0; column < grid.columns; ++column) {
      const Cell cell = cells[static_cast<std::size_t>(row * grid.columns + column)];
      drawing.cells.push_back(static_cast<int>(cell));
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
