// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "picolo/host/files.hpp"
#include "picture_layout.hpp"
#include "raster_canvas.hpp"
#include "stroke_font.hpp"
#include "svg_canvas.hpp"

namespace picolo::host {
namespace {

constexpr double kLeft = 92.0;
constexpr double kRight = 28.0;
constexpr double kTop = 104.0;
constexpr double kBottom = 62.0;
constexpr double kWidth = 1100.0;
constexpr double kGap = 26.0;

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(const std::vector<double>& values) {
    for (const double value : values) {
      if (!std::isfinite(value)) { continue; }
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  void pad(double share) {
    if (!(low <= high)) { low = high = 0.0; }
    // A constant, up to rounding, is shown as one: ticks finer than rounding would never end.
    const double size = std::max(std::abs(low), std::abs(high));
    const bool constant = !(high - low > 1e-9 * size);
    const double width = constant ? std::max(size, 1.0) * 0.1 : high - low;
    low -= share * width;
    high += share * width;
  }
};

struct Frame {
  PixelBox box;
  Range x;
  Range y;
  [[nodiscard]] Pixel place(double px, double py) const {
    return {box.left + (px - x.low) / (x.high - x.low) * box.width,
            box.top + box.height - (py - y.low) / (y.high - y.low) * box.height};
  }
};

std::string tick_label(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  return fmt::format("{:.{}f}", std::abs(value) < 1e-9 * step ? 0.0 : value, decimals);
}

template <typename Action>
void each_tick(const Range& range, double step, Action action) {
  for (double k = std::ceil(range.low / step); k * step <= range.high; ++k) { action(k * step); }
}

void draw_axes(const Frame& frame, const Panel& panel, bool last, const std::string& x_label,
               Canvas& canvas) {
  const PixelBox& box = frame.box;
  const TextStyle faint{13.0, palette::kFaintInk, Anchor::middle, false, false};
  const double bottom = box.top + box.height;
  const double x_step = round_step((frame.x.high - frame.x.low) / 8.0);
  each_tick(frame.x, x_step, [&](double x) {
    const double at = frame.place(x, frame.y.low).x;
    canvas.fill({at - 0.5, box.top, 1.0, box.height}, palette::kGrid);
    if (last) { canvas.text({at, bottom + 20.0}, tick_label(x, x_step), faint); }
  });
  const double y_step = round_step((frame.y.high - frame.y.low) / 4.0);
  each_tick(frame.y, y_step, [&](double y) {
    const double at = frame.place(frame.x.low, y).y;
    canvas.fill({box.left, at - 0.5, box.width, 1.0}, palette::kGrid);
    canvas.text({box.left - 8.0, at + 4.5}, tick_label(y, y_step),
                {13.0, palette::kFaintInk, Anchor::end, false, false});
  });
  canvas.polyline(std::array{Pixel{box.left, box.top}, Pixel{box.left + box.width, box.top},
                             Pixel{box.left + box.width, bottom}, Pixel{box.left, bottom},
                             Pixel{box.left, box.top}},
                  palette::kFaintInk, 1.0);
  canvas.text({24.0, box.top + 0.5 * box.height}, panel.y_label,
              {14.0, palette::kInk, Anchor::middle, false, true});
  if (last) {
    canvas.text({box.left + 0.5 * box.width, bottom + 46.0}, x_label,
                {14.0, palette::kInk, Anchor::middle, false, false});
  }
}

void draw_curves(const Frame& frame, const Panel& panel, Canvas& canvas) {
  canvas.clip(frame.box);
  for (const Curve& curve : panel.curves) {
    std::vector<Pixel> placed;
    for (std::size_t i = 0; i < curve.x.size() && i < curve.y.size(); ++i) {
      const Pixel next = frame.place(curve.x[i], curve.y[i]);
      if (std::isfinite(next.x) && std::isfinite(next.y)) { placed.push_back(next); }
    }
    canvas.polyline(placed, curve.colour, curve.width_px);
  }
}

void draw_heading(const Chart& chart, Canvas& canvas) {
  canvas.text({kLeft, 34.0}, chart.title, {21.0, palette::kInk, Anchor::start, true, false});
  canvas.text({kLeft, 59.0}, chart.note, {14.0, palette::kFaintInk, Anchor::start, false, false});
  double x = kLeft;
  std::set<std::string> named;
  for (const Panel& panel : chart.panels) {
    for (const Curve& curve : panel.curves) {
      if (curve.label.empty() || !named.insert(curve.label).second) { continue; }
      canvas.polyline(std::array{Pixel{x, 81.0}, Pixel{x + 28.0, 81.0}}, curve.colour,
                      curve.width_px + 0.5);
      canvas.text({x + 36.0, 86.0}, curve.label,
                  {14.0, palette::kInk, Anchor::start, false, false});
      x += 72.0 + text_width(curve.label, 14.0);
    }
  }
}

double panel_height(const Chart& chart) {
  return chart.panels.size() == 1 ? 420.0 : 210.0;
}

double height_of(const Chart& chart) {
  const auto count = static_cast<double>(chart.panels.size());
  return kTop + count * panel_height(chart) + (count - 1.0) * kGap + kBottom;
}

void draw(const Chart& chart, Canvas& canvas) {
  const PixelBox whole{0.0, 0.0, kLeft + kWidth + kRight, height_of(chart)};
  draw_heading(chart, canvas);
  Range x;
  for (const Panel& panel : chart.panels) {
    for (const Curve& curve : panel.curves) { x.add(curve.x); }
  }
  x.pad(0.01);
  double top = kTop;
  for (const Panel& panel : chart.panels) {
    Frame frame{{kLeft, top, kWidth, panel_height(chart)}, x, {}};
    for (const Curve& curve : panel.curves) { frame.y.add(curve.y); }
    frame.y.pad(0.06);
    draw_axes(frame, panel, &panel == &chart.panels.back(), chart.x_label, canvas);
    draw_curves(frame, panel, canvas);
    canvas.clip(whole);
    top += panel_height(chart) + kGap;
  }
}

}  // namespace

void write_chart(const Chart& chart, const std::filesystem::path& folder, const std::string& stem) {
  const auto width = static_cast<std::size_t>(kLeft + kWidth + kRight);
  const auto height = static_cast<std::size_t>(height_of(chart));
  SvgCanvas svg{width, height, palette::kPaper};
  draw(chart, svg);
  write_file(folder / (stem + ".svg"), svg.result());
  RasterCanvas png{width, height, palette::kPaper};
  draw(chart, png);
  write_file(folder / (stem + ".png"), encode_png(png.result(), false));
}

}  // namespace picolo::host
