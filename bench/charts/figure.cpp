#include "figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace slideway::charts {
namespace {

// In SVG's user units, which a page scales to its width: text stays legible on a phone, where 640 become 360.
constexpr double width = 640, left = 74, right = 18, plot_height = 400, line_height = 22, text_size = 15;

constexpr char style[] = R"(<style>
svg{--paper:#fff;--ink:#17202b;--quiet:#556272;--grid:#e3e8ed;--axis:#8b97a5;
--s0:#0072b2;--s1:#d55e00;--s2:#00875f;--s3:#a6498a;--s4:#8a6d00;--s5:#2a91cc;--s6:#5b6675;--s7:#5b3fa6;
font:15px system-ui,"Segoe UI",Roboto,"Helvetica Neue","DejaVu Sans",sans-serif}
@media(prefers-color-scheme:dark){svg{--paper:#12171d;--ink:#e8edf2;--quiet:#9dabb9;--grid:#2a333d;--axis:#66727f;
--s0:#56b4e9;--s1:#f58a42;--s2:#35c797;--s3:#e08cc2;--s4:#d9b93b;--s5:#a8d8f5;--s6:#a3b0bd;--s7:#a996f0}}
text{fill:var(--ink)}.q{fill:var(--quiet)}.f{font-size:11px}.t{font-weight:600;font-size:18px}
.g{stroke:var(--grid)}.a{stroke:var(--axis)}path,polyline{fill:none;stroke-width:2;stroke-linejoin:round}
.n{paint-order:stroke;stroke:var(--paper);stroke-width:4px;stroke-linejoin:round}
</style>)";

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&') {
      safe += "&amp;";
    } else if (c == '<') {
      safe += "&lt;";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string colour_of(int colour) { return fmt::format("var(--s{})", colour); }

/// An axis' numbers: places from 0 to 1, and texts.
struct Tick {
  double place;
  std::string text;  ///< empty: a line alone
};

double place_of(const Axis& axis, double x) {
  if (axis.logarithmic) return std::log10(x / axis.from) / std::log10(axis.to / axis.from);
  return (x - axis.from) / (axis.to - axis.from);
}

std::string power_of_ten(int exponent) {
  if (exponent >= 0 && exponent <= 3) return fmt::format("{}", std::lround(std::pow(10, exponent)));
  return fmt::format("10<tspan dy=\"-6\" font-size=\"11\">{}</tspan>",
                     exponent < 0 ? fmt::format("−{}", -exponent) : fmt::format("{}", exponent));
}

std::vector<Tick> logarithmic_ticks(const Axis& axis) {
  std::vector<Tick> ticks;
  const double low = std::log10(std::min(axis.from, axis.to)), high = std::log10(std::max(axis.from, axis.to));
  const int every = std::max(1, static_cast<int>(std::ceil((high - low) / 9)));
  for (int e = static_cast<int>(std::ceil(low - 1e-9)); e <= high + 1e-9; ++e) {
    ticks.push_back({place_of(axis, std::pow(10, e)), e % every == 0 ? power_of_ten(e) : ""});
  }
  if (ticks.size() > 2) return ticks;
  ticks.clear();  // less than two decades: 1, 2, 5
  for (int e = static_cast<int>(std::floor(low)); e <= high; ++e) {
    for (const int digit : {1, 2, 5}) {
      const double x = digit * std::pow(10, e), p = place_of(axis, x);
      if (p > -1e-9 && p < 1 + 1e-9) ticks.push_back({p, fmt::format("{:g}", x)});
    }
  }
  return ticks;
}

std::vector<Tick> ticks_of(const Axis& axis) {
  if (axis.logarithmic) return logarithmic_ticks(axis);
  std::vector<Tick> ticks;
  const double range = std::fabs(axis.to - axis.from);
  double step = std::pow(10, std::floor(std::log10(range / 4)));
  for (const double factor : {2.0, 2.5, 2.0}) {
    if (range / step > 8) step *= factor;
  }
  const double low = std::min(axis.from, axis.to);
  for (double x = std::ceil(low / step - 1e-9) * step; x <= low + range * (1 + 1e-9); x += step) {
    const double clean = std::round(x / step) * step + 0.0;
    ticks.push_back({place_of(axis, clean), fmt::format("{:g}", clean)});
  }
  return ticks;
}

/// The figure as it grows, and the frame of its plot.
class Drawing {
 public:
  Drawing(const std::string& title, const std::string& subtitle, const std::string& foot, const Axis& x, const Axis& y,
          int legend_lines)
      : x_(x), y_(y), top_(subtitle.empty() ? 40 : 40 + line_height) {
    height_ = top_ + plot_height + 62 + legend_lines * line_height + (foot.empty() ? 0 : line_height);
    text_ =
        fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" role=\"img\">\n", width, height_);
    text_ += fmt::format("<title>{}</title>\n{}\n", escaped(title), style);
    text_ += "<rect width=\"100%\" height=\"100%\" fill=\"var(--paper)\"/>\n";
    text_ += fmt::format("<text class=\"t\" x=\"12\" y=\"26\">{}</text>\n", escaped(title));
    if (!subtitle.empty()) text_ += fmt::format("<text class=\"q\" x=\"12\" y=\"48\">{}</text>\n", escaped(subtitle));
    text_ += fmt::format("<text class=\"q f\" x=\"12\" y=\"{}\">{}</text>\n", height_ - 9, escaped(foot));
  }

  double across(double x) const { return left + (width - left - right) * place_of(x_, x); }
  double down(double y) const { return top_ + plot_height * (1 - place_of(y_, y)); }

  void axes() {
    for (const Tick& tick : ticks_of(x_)) {
      const double at = left + (width - left - right) * tick.place;
      text_ += fmt::format("<path class=\"g\" style=\"stroke-width:1\" d=\"M{0:.1f} {1}V{2}\"/>", at, top_,
                           top_ + plot_height);
      text_ += fmt::format("<text class=\"q\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", at,
                           top_ + plot_height + 20, tick.text);
    }
    for (const Tick& tick : ticks_of(y_)) {
      const double at = top_ + plot_height * (1 - tick.place);
      text_ +=
          fmt::format("<path class=\"g\" style=\"stroke-width:1\" d=\"M{0} {2:.1f}H{1}\"/>", left, width - right, at);
      text_ += fmt::format("<text class=\"q\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", left - 8, at + 5,
                           tick.text);
    }
  }

  /// Over what was drawn in the plot.
  void frame() {
    text_ += fmt::format("<rect class=\"a\" fill=\"none\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", left, top_,
                         width - left - right, plot_height);
    text_ += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", (left + width - right) / 2,
                         top_ + plot_height + 44, escaped(x_.label));
    text_ += fmt::format("<text transform=\"translate(18 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                         top_ + plot_height / 2, escaped(y_.label));
  }

  void begin_plot() {
    text_ += fmt::format(
        "<clipPath id=\"p\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>"
        "<g clip-path=\"url(#p)\">\n",
        left - 6, top_ - 6, width - left - right + 12, plot_height + 12);
  }
  void end_plot() { text_ += "</g>\n"; }

  /// Cells of one category, from one column to before another: one shape, so that no seams show.
  void cells(int column, int end, int row, int columns, int rows, const Category& category) {
    const double across = (width - left - right) / columns, w = across * (end - column), h = plot_height / rows;
    text_ += fmt::format(
        "<path style=\"stroke:none;fill:{};fill-opacity:{}\" d=\"M{:.2f} {:.2f}h{:.2f}v{:.2f}h-{:.2f}z\"/>\n",
        colour_of(category.colour), category.strength, left + column * across, top_ + plot_height - (row + 1) * h, w, h,
        w);
  }

  void line(const Line& line) {
    const std::string colour = colour_of(line.style.colour);
    std::string points;
    for (const auto& p : line.points) points += fmt::format("{:.1f},{:.1f} ", across(p[0]), down(p[1]));
    text_ += fmt::format("<polyline style=\"stroke:{}{}\" points=\"{}\"/>\n", colour,
                         line.style.dashed ? ";stroke-dasharray:6 4" : "", points);
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const double x = across(line.points[i][0]), y = down(line.points[i][1]);
      if (i < line.spread.size()) {
        text_ +=
            fmt::format("<path style=\"stroke:{};stroke-opacity:.5;stroke-width:4\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>\n",
                        colour, across(line.spread[i][0]), y, across(line.spread[i][1]));
      }
      marker(line.style, x, y);
    }
  }

  void note(const Note& note) {
    text_ += fmt::format("<text class=\"n\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", across(note.at[0]),
                         down(note.at[1]), escaped(note.text));
  }

  /// Two columns; place counts from 0.
  void legend(int place, const std::string& name, const Style& of) {
    const auto [x, y] = legend_at(place);
    text_ += fmt::format("<path style=\"stroke:{}{}\" d=\"M{} {}h34\"/>", colour_of(of.colour),
                         of.dashed ? ";stroke-dasharray:6 4" : "", x, y);
    marker(of, x + 17, y);
    text_ += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", x + 42, y + 5, escaped(name));
  }
  void legend(int place, const Category& category) {
    const auto [x, y] = legend_at(place);
    text_ += fmt::format(
        "<rect class=\"a\" style=\"fill:{};fill-opacity:{}\" x=\"{}\" y=\"{}\" width=\"26\" height=\"14\"/>",
        colour_of(category.colour), category.strength, x + 8, y - 7);
    text_ += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", x + 42, y + 5, escaped(category.name));
  }

  std::string finished() const { return text_ + "</svg>\n"; }

 private:
  struct Place {
    double x, y;
  };
  Place legend_at(int place) const {
    return {place % 2 == 0 ? 24.0 : 24.0 + (width - 24) / 2, top_ + plot_height + 68 + place / 2 * line_height};
  }

  void marker(const Style& of, double x, double y) {
    static constexpr const char* shapes[] = {"M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0z", "M-4-4h8v8h-8z",
                                             "M0-5.5L5 4H-5z", "M0-5.5L5.5 0L0 5.5L-5.5 0z"};
    if (of.marker < 0) return;
    const std::string colour = colour_of(of.colour);
    if (of.marker < 4) {
      text_ += fmt::format(
          "<path transform=\"translate({:.1f} {:.1f})\" style=\"fill:{};stroke:var(--paper);stroke-width:1\" "
          "d=\"{}\"/>\n",
          x, y, colour, shapes[of.marker]);
    } else if (of.marker == 4) {
      text_ +=
          fmt::format("<path transform=\"translate({:.1f} {:.1f})\" style=\"stroke:{}\" d=\"M-4-4L4 4M-4 4L4-4\"/>\n",
                      x, y, colour);
    } else {
      text_ += fmt::format(
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.2\" style=\"stroke:{};stroke-width:2;fill:var(--paper)\"/>\n", x,
          y, colour);
    }
  }

  const Axis &x_, &y_;
  double top_, height_ = 0;
  std::string text_;
};

template <class Figure>
int legend_entries(const Figure& figure) {
  return static_cast<int>(
      std::count_if(figure.lines.begin(), figure.lines.end(), [](const Line& line) { return !line.name.empty(); }));
}

template <class Figure>
void draw_lines(const Figure& figure, int place, Drawing& drawing) {
  drawing.begin_plot();
  for (const Line& line : figure.lines) drawing.line(line);
  drawing.end_plot();
  for (const Note& note : figure.notes) drawing.note(note);
  drawing.frame();
  for (const Line& line : figure.lines) {
    if (!line.name.empty()) drawing.legend(place++, line.name, line.style);
  }
}

}  // namespace

std::string svg(const Chart& chart, const std::string& foot) {
  Drawing drawing(chart.title, chart.subtitle, foot, chart.x, chart.y, (legend_entries(chart) + 1) / 2);
  drawing.axes();
  draw_lines(chart, 0, drawing);
  return drawing.finished();
}

std::string svg(const Map& map, const std::string& foot) {
  const int categories = static_cast<int>(map.categories.size());
  Drawing drawing(map.title, map.subtitle, foot, map.x, map.y, (categories + legend_entries(map) + 1) / 2);
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0, end = 0; column < map.columns; column = end) {
      const auto at = [&](int k) { return map.cells[static_cast<std::size_t>(row * map.columns + k)]; };
      while (end < map.columns && at(end) == at(column)) ++end;
      if (at(column) < 0) continue;
      drawing.cells(column, end, row, map.columns, map.rows, map.categories[static_cast<std::size_t>(at(column))]);
    }
  }
  drawing.axes();
  draw_lines(map, categories, drawing);
  for (int c = 0; c < categories; ++c) drawing.legend(c, map.categories[static_cast<std::size_t>(c)]);
  return drawing.finished();
}

}  // namespace slideway::charts
