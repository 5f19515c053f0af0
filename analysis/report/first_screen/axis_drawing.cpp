#include "analysis/report/first_screen/axis_drawing.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/document/markup.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::report {
namespace {

constexpr double font = 12.0;
constexpr double line_height = 15.0;
constexpr double padding = 8.0;
constexpr double letter = 0.57 * font;  ///< width of a mean letter
constexpr double sum_radius = 9.0;

struct Box {
  double x{0.0}, y{0.0}, width{0.0}, height{0.0};

  double right() const { return x + width; }
  double bottom() const { return y + height; }
  double middle_x() const { return x + width / 2; }
  double middle_y() const { return y + height / 2; }
};

/// The text in lines of the width, broken at spaces.
std::vector<std::string> wrapped(const std::string& text, double width) {
  const auto most = static_cast<std::size_t>((width - 2 * padding) / letter);
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (!line.empty() && text::display_width(line) + 1 + text::display_width(word) > most)
      lines.push_back(std::exchange(line, ""));
    line += (line.empty() ? "" : " ") + word;
    at = end + 1;
  }
  lines.push_back(line);
  return lines;
}

/// A block with its lines as they fit its width.
DiagramBlock fitted(const DiagramBlock& block, double width) {
  DiagramBlock fit{block.title, {}};
  for (const std::string& line : block.lines) {
    for (std::string& part : wrapped(line, width)) fit.lines.push_back(std::move(part));
  }
  return fit;
}

double height_of(const DiagramBlock& block) {
  return 2 * padding + line_height * static_cast<double>(1 + block.lines.size());
}

/// Collects the elements of a drawing.
class Drawing {
 public:
  Drawing(std::string kind, double width) : kind_(std::move(kind)), width_(width) {}

  void block(const Box& box, const DiagramBlock& fit) {
    rectangle(box);
    text_of(box, fit);
  }
  /// Two blocks in one frame, of which the second acts on the first.
  void joined(const Box& box, const DiagramBlock& upper, const DiagramBlock& lower) {
    rectangle(box);
    text_of(box, upper);
    const Box below{box.x, box.y + height_of(upper), box.width, box.height - height_of(upper)};
    path(fmt::format("M{:.0f} {:.0f}H{:.0f}", below.x, below.y, below.right()), false, "divider");
    text_of(below, lower);
  }
  void sum(double x, double y) {
    elements_ += fmt::format("<circle cx=\"{:.0f}\" cy=\"{:.0f}\" r=\"{:.0f}\"/>", x, y, sum_radius);
  }
  void path(const std::string& course, bool is_arrow = true, std::string_view style = "signal") {
    elements_ += fmt::format("<path class=\"{}\" d=\"{}\"{}/>", style, course,
                             is_arrow ? fmt::format(" marker-end=\"url(#tip-{})\"", kind_) : "");
  }
  void label(double x, double y, std::string_view text) {
    elements_ += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\">{}</text>", x, y, text);
  }

  std::string svg(double height) const {
    return fmt::format(
        "<svg class=\"axis {0}\" viewBox=\"0 0 {1:.0f} {2:.0f}\" role=\"img\" aria-label=\"Block diagram of "
        "the "
        "axis\"><defs><marker id=\"tip-{0}\" viewBox=\"0 0 8 8\" refX=\"8\" refY=\"4\" markerWidth=\"8\" "
        "markerHeight=\"8\" orient=\"auto-start-reverse\"><path d=\"M0 0L8 4L0 "
        "8z\"/></marker></defs>{3}</svg>\n",
        kind_, width_, height, elements_);
  }

 private:
  void rectangle(const Box& box) {
    elements_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"3\"/>",
                             box.x + 0.5, box.y + 0.5, box.width - 1, box.height - 1);
  }
  void text_of(const Box& box, const DiagramBlock& fit) {
    double y = box.y + padding + font;
    elements_ += fmt::format("<text class=\"title\" x=\"{:.0f}\" y=\"{:.0f}\">{}</text>", box.x + padding, y,
                             document::markup(fit.title));
    for (const std::string& line : fit.lines) {
      y += line_height;
      label(box.x + padding, y, document::markup(line));
    }
  }

  std::string kind_;
  double width_;
  std::string elements_;
};

/// The blocks of the forward path that both drawings have, fitted to their widths.
struct FittedPlant {
  DiagramBlock plant;
  std::optional<DiagramBlock> friction;
  double height;
};

FittedPlant fitted_plant(const AxisDiagram& diagram, double width) {
  FittedPlant fit{fitted(diagram.plant, width), std::nullopt, 0.0};
  fit.height = height_of(fit.plant);
  if (!diagram.friction) return fit;
  fit.friction = fitted(*diagram.friction, width);
  fit.height += height_of(*fit.friction);
  return fit;
}

void draw_plant(Drawing& drawing, const Box& box, const FittedPlant& fit) {
  if (fit.friction) {
    drawing.joined(box, fit.plant, *fit.friction);
  } else {
    drawing.block(box, fit.plant);
  }
}

/// The disturbance is a sentence beside its arrow.
std::string disturbance_text(const DiagramBlock& block) {
  std::string text = block.title + ":";
  for (const std::string& line : block.lines) text += (text.back() == ':' ? " " : ", ") + line;
  return document::markup(text);
}

/// From left to right, the encoder below in the feedback.
class WideDrawing {
 public:
  explicit WideDrawing(const AxisDiagram& diagram) : diagram_(diagram) {}

  std::string svg() {
    const DiagramBlock reference = fitted(diagram_.reference, reference_width);
    const DiagramBlock drive = fitted(diagram_.drive, drive_width);
    const FittedPlant plant = fitted_plant(diagram_, plant_width);
    const DiagramBlock encoder = fitted(diagram_.encoder, encoder_width);
    const double row = std::max({height_of(reference), controller_height(), height_of(drive), plant.height});
    const double middle = top() + row / 2;
    place(reference, reference_x, reference_width, middle);
    const double drive_x = diagram_.controller ? closed_drive_x : controller_x;
    const Box drive_box = place(drive, drive_x, drive_width, middle);
    const Box plant_box{plant_x, middle - plant.height / 2, plant_width, plant.height};
    draw_plant(drawing_, plant_box, plant);
    draw_disturbance(plant_box);
    const Box encoder_box{closed_drive_x - 120, top() + row + gap, encoder_width, height_of(encoder)};
    drawing_.block(encoder_box, encoder);
    if (diagram_.controller)
      draw_control(middle, encoder_box);
    else
      arrow(reference_x + reference_width, drive_x, middle);
    arrow(drive_box.right(), plant_x, middle);
    // The position goes round below.
    drawing_.path(fmt::format("M{:.0f} {:.0f}H{:.0f}V{:.0f}H{:.0f}", plant_box.right(), middle, width - 8,
                              encoder_box.middle_y(), encoder_box.right()));
    return drawing_.svg(encoder_box.bottom() + 2);
  }

 private:
  static constexpr double width = 1000;
  static constexpr double gap = 14;
  static constexpr double reference_x = 0, reference_width = 172;
  static constexpr double sum_x = 200;
  static constexpr double controller_x = 234, controller_width = 258;
  static constexpr double closed_drive_x = 520, drive_width = 166;
  static constexpr double plant_x = 714, plant_width = 256;
  static constexpr double encoder_width = 240;

  double top() const { return diagram_.disturbance ? 26 : 2; }

  double controller_height() const {
    return diagram_.controller ? height_of(fitted(*diagram_.controller, controller_width)) : 0.0;
  }
  Box place(const DiagramBlock& fit, double x, double block_width, double middle) {
    const Box box{x, middle - height_of(fit) / 2, block_width, height_of(fit)};
    drawing_.block(box, fit);
    return box;
  }
  void arrow(double from, double to, double y) {
    drawing_.path(fmt::format("M{:.0f} {:.0f}H{:.0f}", from, y, to));
  }
  void draw_control(double middle, const Box& encoder) {
    place(fitted(*diagram_.controller, controller_width), controller_x, controller_width, middle);
    drawing_.sum(sum_x, middle);
    arrow(reference_x + reference_width, sum_x - sum_radius, middle);
    arrow(sum_x + sum_radius, controller_x, middle);
    arrow(controller_x + controller_width, closed_drive_x, middle);
    drawing_.path(fmt::format("M{:.0f} {:.0f}H{:.0f}V{:.0f}", encoder.x, encoder.middle_y(), sum_x,
                              middle + sum_radius));
    drawing_.label(sum_x + 6, middle + sum_radius + 14, "−");
  }
  void draw_disturbance(const Box& plant) {
    if (!diagram_.disturbance) return;
    const std::string text = disturbance_text(*diagram_.disturbance);
    drawing_.path(fmt::format("M{:.0f} 16V{:.0f}", plant.middle_x(), plant.y));
    drawing_.label(plant.x - 120, 12, text);
  }

  const AxisDiagram& diagram_;
  Drawing drawing_{"wide", width};
};

/// From top to bottom, the feedback on the right.
class TallDrawing {
 public:
  explicit TallDrawing(const AxisDiagram& diagram) : diagram_(diagram) {}

  std::string svg() {
    place(diagram_.reference);
    double sum_y = 0.0;
    if (diagram_.controller) {
      sum_y = y_ + sum_radius;
      drawing_.sum(block_width / 2, sum_y);
      y_ += 2 * sum_radius + gap;
      arrow_above();
      place(*diagram_.controller);
    }
    place(diagram_.drive);
    if (diagram_.disturbance) place(*diagram_.disturbance);
    const FittedPlant plant = fitted_plant(diagram_, block_width);
    draw_plant(drawing_, {0, y_, block_width, plant.height}, plant);
    y_ += plant.height + gap;
    arrow_above();
    const Box encoder = place(diagram_.encoder, false);
    if (diagram_.controller) {
      drawing_.path(fmt::format("M{:.0f} {:.0f}H{:.0f}V{:.0f}H{:.0f}", block_width, encoder.middle_y(),
                                width - 8, sum_y, block_width / 2 + sum_radius));
      drawing_.label(block_width / 2 + sum_radius + 12, sum_y - 4, "−");
    }
    return drawing_.svg(encoder.bottom() + 2);
  }

 private:
  static constexpr double width = 340;
  static constexpr double block_width = 306;
  static constexpr double gap = 18;

  /// The arrow in the gap above the next block.
  void arrow_above() { drawing_.path(fmt::format("M{:.0f} {:.0f}V{:.0f}", block_width / 2, y_ - gap, y_)); }
  Box place(const DiagramBlock& block, bool is_followed = true) {
    const DiagramBlock fit = fitted(block, block_width);
    const Box box{0, y_, block_width, height_of(fit)};
    drawing_.block(box, fit);
    y_ += box.height;
    if (!is_followed) return box;
    y_ += gap;
    arrow_above();
    return box;
  }

  const AxisDiagram& diagram_;
  Drawing drawing_{"tall", width};
  double y_{1.0};
};

}  // namespace

std::string axis_svg(const AxisDiagram& diagram) {
  return WideDrawing(diagram).svg() + TallDrawing(diagram).svg();
}

}  // namespace zerocount::report
