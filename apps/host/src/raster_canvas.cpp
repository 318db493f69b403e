// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "raster_canvas.hpp"

#include <algorithm>
#include <cmath>

#include "stroke_font.hpp"

namespace picolo::host {
namespace {

std::size_t to_pixel(double value, std::size_t limit) {
  return static_cast<std::size_t>(std::clamp(value, 0.0, static_cast<double>(limit)));
}

double distance_to_segment(Pixel p, Pixel a, Pixel b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double length2 = dx * dx + dy * dy;
  const double share =
      length2 > 0.0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(p.x - a.x - share * dx, p.y - a.y - share * dy);
}

double overlap(double a_low, double a_high, double b_low, double b_high) {
  return std::max(0.0, std::min(a_high, b_high) - std::max(a_low, b_low));
}

}  // namespace

RasterCanvas::RasterCanvas(std::size_t width, std::size_t height, Colour background)
    : image_{width, height, std::vector<Colour>(width * height, background)},
      clip_{0.0, 0.0, static_cast<double>(width), static_cast<double>(height)},
      cover_(width * height, 0.0F),
      dirty_{width, height, 0, 0} {}

void RasterCanvas::clip(const PixelBox& box) {
  clip_ = box;
}

RasterCanvas::Window RasterCanvas::window(double left, double top, double right,
                                          double bottom) const {
  return {to_pixel(std::floor(std::max(left, clip_.left)), image_.width),
          to_pixel(std::floor(std::max(top, clip_.top)), image_.height),
          to_pixel(std::ceil(std::min(right, clip_.left + clip_.width)), image_.width),
          to_pixel(std::ceil(std::min(bottom, clip_.top + clip_.height)), image_.height)};
}

void RasterCanvas::blend(std::size_t column, std::size_t row, Colour colour, double cover) {
  Colour& pixel = image_.pixels[row * image_.width + column];
  const double share = cover * colour.alpha / 255.0;
  const auto mix = [share](std::uint8_t below, std::uint8_t above) {
    return static_cast<std::uint8_t>(std::lround(below + share * (above - below)));
  };
  pixel = {mix(pixel.red, colour.red), mix(pixel.green, colour.green), mix(pixel.blue, colour.blue),
           255};
}

void RasterCanvas::fill(const PixelBox& box, Colour colour) {
  const double right = box.left + box.width;
  const double bottom = box.top + box.height;
  const Window area = window(box.left, box.top, right, bottom);
  for (std::size_t row = area.top; row < area.bottom; ++row) {
    const auto y = static_cast<double>(row);
    const double rows = overlap(y, y + 1.0, box.top, bottom);
    for (std::size_t column = area.left; column < area.right; ++column) {
      const auto x = static_cast<double>(column);
      blend(column, row, colour, rows * overlap(x, x + 1.0, box.left, right));
    }
  }
}

void RasterCanvas::cover_segment(Pixel from, Pixel to, double half_width_px) {
  const double reach = half_width_px + 1.0;
  const Window area = window(std::min(from.x, to.x) - reach, std::min(from.y, to.y) - reach,
                             std::max(from.x, to.x) + reach, std::max(from.y, to.y) + reach);
  for (std::size_t row = area.top; row < area.bottom; ++row) {
    for (std::size_t column = area.left; column < area.right; ++column) {
      const Pixel centre{static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5};
      const double edge = half_width_px + 0.5 - distance_to_segment(centre, from, to);
      float& cover = cover_[row * image_.width + column];
      cover = std::max(cover, static_cast<float>(std::clamp(edge, 0.0, 1.0)));
    }
  }
  if (area.left < area.right && area.top < area.bottom) {
    dirty_ = {std::min(dirty_.left, area.left), std::min(dirty_.top, area.top),
              std::max(dirty_.right, area.right), std::max(dirty_.bottom, area.bottom)};
  }
}

/// One blend a shape: where its segments overlap it is not darker.
void RasterCanvas::blend_cover(Colour colour) {
  for (std::size_t row = dirty_.top; row < dirty_.bottom; ++row) {
    for (std::size_t column = dirty_.left; column < dirty_.right; ++column) {
      float& cover = cover_[row * image_.width + column];
      if (cover > 0.0F) {
        blend(column, row, colour, static_cast<double>(cover));
        cover = 0.0F;
      }
    }
  }
  dirty_ = {image_.width, image_.height, 0, 0};
}

void RasterCanvas::polyline(std::span<const Pixel> points, Colour colour, double width_px) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    cover_segment(points[i], points[i + 1], 0.5 * width_px);
  }
  blend_cover(colour);
}

void RasterCanvas::dots(std::span<const Pixel> centres, Colour colour, double radius_px) {
  for (const Pixel& centre : centres) { cover_segment(centre, centre, radius_px); }
  blend_cover(colour);
}

void RasterCanvas::text(Pixel at, const std::string& words, const TextStyle& style) {
  const double scale = style.size_px * kCapPerSize / kCapHeight;
  const double width = text_width(words, style.size_px);
  double along =
      style.anchor == Anchor::start ? 0.0 : (style.anchor == Anchor::end ? -width : -0.5 * width);
  const double half_width_px = style.size_px * (style.bold ? 0.062 : 0.043);
  for (const char character : words) {
    const Glyph glyph = stroke_glyph(character);
    for (const auto& stroke : glyph.strokes) {
      const auto place = [&](const Pixel& p) {
        const double right = along + p.x * scale;
        const double up = p.y * scale;
        return style.upward ? Pixel{at.x - up, at.y - right} : Pixel{at.x + right, at.y - up};
      };
      for (std::size_t i = 0; i + 1 < stroke.size(); ++i) {
        cover_segment(place(stroke[i]), place(stroke[i + 1]), half_width_px);
      }
    }
    along += glyph.advance * scale;
  }
  blend_cover(style.colour);
}

/// Every canvas pixel is the mean of what it covers of the image.
void RasterCanvas::image(const PixelBox& box, const ColourImage& pixels) {
  const Window area = window(box.left, box.top, box.left + box.width, box.top + box.height);
  const double columns_per_px = static_cast<double>(pixels.width) / box.width;
  const double rows_per_px = static_cast<double>(pixels.height) / box.height;
  for (std::size_t row = area.top; row < area.bottom; ++row) {
    const double v0 = (static_cast<double>(row) - box.top) * rows_per_px;
    const double v1 = v0 + rows_per_px;
    for (std::size_t column = area.left; column < area.right; ++column) {
      const double u0 = (static_cast<double>(column) - box.left) * columns_per_px;
      const double u1 = u0 + columns_per_px;
      double red = 0.0;
      double green = 0.0;
      double blue = 0.0;
      double weight = 0.0;
      for (std::size_t v = to_pixel(v0, pixels.height); v < to_pixel(std::ceil(v1), pixels.height);
           ++v) {
        for (std::size_t u = to_pixel(u0, pixels.width); u < to_pixel(std::ceil(u1), pixels.width);
             ++u) {
          const Colour& source = pixels.pixels[v * pixels.width + u];
          const auto x = static_cast<double>(u);
          const auto y = static_cast<double>(v);
          const double share =
              overlap(u0, u1, x, x + 1.0) * overlap(v0, v1, y, y + 1.0) * source.alpha / 255.0;
          red += share * source.red;
          green += share * source.green;
          blue += share * source.blue;
          weight += share;
        }
      }
      if (weight > 0.0) {
        const auto mean = [weight](double sum) {
          return static_cast<std::uint8_t>(std::lround(sum / weight));
        };
        blend(column, row, {mean(red), mean(green), mean(blue), 255},
              std::min(1.0, weight / (columns_per_px * rows_per_px)));
      }
    }
  }
}

}  // namespace picolo::host
