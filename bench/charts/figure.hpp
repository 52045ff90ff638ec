// Charts and maps as SVG: one style for all, readable in light and dark.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace slideway::charts {

struct Axis {
  std::string label;        ///< with unit
  double from = 0, to = 1;  ///< to < from runs the other way
  bool logarithmic = false;
};

using Points = std::vector<std::array<double, 2>>;

/// How a line is drawn. Colours are numbered 0 to 7, markers 0 to 5 (disc, square, triangle, diamond, cross, ring), -1:
/// none.
struct Style {
  int colour = 0, marker = 0;
  bool dashed = false;
};

struct Line {
  std::string name;  ///< in the legend; empty: not there
  Style style;
  Points points;
  std::vector<std::array<double, 2>> spread;  ///< from and to in x, of each point; or empty
};

/// Words in the plot, at data coordinates.
struct Note {
  std::array<double, 2> at;
  std::string text;
};

/// Lines over two axes. Points beyond the axes are cut off.
struct Chart {
  std::string title, subtitle;
  Axis x, y;
  std::vector<Line> lines;
  std::vector<Note> notes;
};

/// What a cell of a map can be.
struct Category {
  std::string name;
  int colour = 0;
  double strength = 1;  ///< of the colour on paper, 0 to 1
};

/// Cells of a grid, row by row from the bottom; -1: nothing there. Lines lie over them.
struct Map {
  std::string title, subtitle;
  Axis x, y;
  int columns = 0, rows = 0;
  std::vector<int> cells;
  std::vector<Category> categories;
  std::vector<Line> lines;
  std::vector<Note> notes;
};

/// `foot` tells how it was made.
std::string svg(const Chart& chart, const std::string& foot = "");
std::string svg(const Map& map, const std::string& foot = "");

}  // namespace slideway::charts
