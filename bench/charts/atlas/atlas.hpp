// The stability atlas: where methods fail, and whether they say so. Each map is a grid of cases, each case judged
// against exact arithmetic, a closed form or a much finer run; atlas_NAME.cpp says which.
#pragma once

#include <functional>
#include <slideway/io/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "figure.hpp"
#include "motion/equations.hpp"

namespace slideway::charts {

/// What a method makes of one case.
enum class Cell : signed char {
  right,
  refused_rightly,  ///< there is no answer, or none that doubles hold, and the status is the one for that
  refused_late,     ///< by the step after the one that went beyond the last answer
  warned,           ///< off, and the report counts the events that were stepped over
  refused_wrongly,  ///< there is an answer, or the status names another reason
  wrong             ///< in silence: a number beyond tolerance with `ok`
};
inline constexpr int cell_kinds = 6;

/// Cases in rows and columns; a cell stands for its middle.
struct Grid {
  Axis x, y;
  int columns, rows;
  double across(int column) const;
  double up(int row) const;
};

struct NamedFigure {
  std::string name;  ///< of the file, without ending
  std::variant<Chart, Map> figure;
};

struct AtlasMap {
  std::string name;
  std::vector<NamedFigure> figures;
  io::Json document;
};

struct AtlasOptions {
  bool quick = false;  ///< coarse grids and short runs, to see that everything still draws
  std::function<RunScene(const std::string&)> scene;  ///< a shipped scene by name
  std::function<void(double, const std::string&)> progress = [](double, const std::string&) {};
};

/// The maps by name, in the order of docs.
struct AtlasEntry {
  std::string name;
  AtlasMap (*draw)(const AtlasOptions&);
};
const std::vector<AtlasEntry>& atlas();

AtlasMap draw_baumgarte(const AtlasOptions& options);
AtlasMap draw_friction(const AtlasOptions& options);
AtlasMap draw_pole(const AtlasOptions& options);
AtlasMap draw_stick_slip(const AtlasOptions& options);
AtlasMap draw_mass_ratio(const AtlasOptions& options);
AtlasMap draw_singular(const AtlasOptions& options);
AtlasMap draw_long_run(const AtlasOptions& options);
AtlasMap draw_units(const AtlasOptions& options);

AtlasMap begin_map(const std::string& name);

/// `judge` for every cell, from the bottom row up.
std::vector<Cell> judge_cells(const Grid& grid, const std::function<Cell(double x, double y)>& judge);

/// A figure of a map's cells. Their counts go into its subtitle, and with the cells into the document.
struct CellFigure {
  std::string name;    ///< of the figure, behind the map's
  std::string method;  ///< who is judged
  std::string title;
  std::vector<Line> lines = {};
  std::vector<Note> notes = {};
};
void add_cells(AtlasMap& map, const CellFigure& figure, const Grid& grid, const std::vector<Cell>& cells);

/// 10^k with `a_decade` of them a decade, from one power of ten to another.
std::vector<double> decades(int from, int to, int a_decade);

}  // namespace slideway::charts
