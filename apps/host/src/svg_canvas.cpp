// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "svg_canvas.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

#include "raster_canvas.hpp"

namespace picolo::host {
namespace {

std::string paint(const char* what, Colour colour) {
  std::string text =
      fmt::format(R"({}="#{:02x}{:02x}{:02x}")", what, colour.red, colour.green, colour.blue);
  if (colour.alpha < 255) {
    text += fmt::format(R"( {}-opacity="{:.3f}")", what, colour.alpha / 255.0);
  }
  return text;
}

std::string escape(std::string_view words) {
  std::string text;
  for (const char character : words) {
    switch (character) {
      case '&': text += "&amp;"; break;
      case '<': text += "&lt;"; break;
      case '>': text += "&gt;"; break;
      default: text += character;
    }
  }
  return text;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t byte =
          i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U;
      group = (group << 8U) | byte;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k < bytes.size() + 1 ? kDigits[(group >> (18U - 6U * k)) & 63U] : '=';
    }
  }
  return text;
}

const char* anchor_name(Anchor anchor) {
  switch (anchor) {
    case Anchor::middle: return "middle";
    case Anchor::end: return "end";
    case Anchor::start: break;
  }
  return "start";
}

}  // namespace

SvgCanvas::SvgCanvas(std::size_t width, std::size_t height, Colour background)
    : body_{fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" )"
                        R"(xmlns:xlink="http://www.w3.org/1999/xlink" width="{0}" height="{1}" )"
                        R"(viewBox="0 0 {0} {1}" font-family="DejaVu Sans,Verdana,sans-serif">)"
                        "\n<g>\n",
                        width, height)} {
  fill({0.0, 0.0, static_cast<double>(width), static_cast<double>(height)}, background);
}

void SvgCanvas::clip(const PixelBox& box) {
  ++clips_;
  body_ += fmt::format(
      "</g>\n<clipPath id=\"clip{0}\">"
      "<rect x=\"{1:.2f}\" y=\"{2:.2f}\" width=\"{3:.2f}\" height=\"{4:.2f}\"/></clipPath>\n"
      "<g clip-path=\"url(#clip{0})\">\n",
      clips_, box.left, box.top, box.width, box.height);
}

void SvgCanvas::fill(const PixelBox& box, Colour colour) {
  body_ += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" {}/>\n",
                       box.left, box.top, box.width, box.height, paint("fill", colour));
}

void SvgCanvas::polyline(std::span<const Pixel> points, Colour colour, double width_px) {
  body_ += "<polyline points=\"";
  for (const Pixel& point : points) { body_ += fmt::format("{:.2f},{:.2f} ", point.x, point.y); }
  body_ += fmt::format(
      R"(" fill="none" {} stroke-width="{:.2f}" stroke-linejoin="round" stroke-linecap="round"/>)"
      "\n",
      paint("stroke", colour), width_px);
}

void SvgCanvas::dots(std::span<const Pixel> centres, Colour colour, double radius_px) {
  body_ += "<path d=\"";
  for (const Pixel& centre : centres) {
    body_ += fmt::format("M{:.1f} {:.1f}h0", centre.x, centre.y);
  }
  body_ += fmt::format("\" {} stroke-width=\"{:.2f}\" stroke-linecap=\"round\"/>\n",
                       paint("stroke", colour), 2.0 * radius_px);
}

void SvgCanvas::text(Pixel at, const std::string& words, const TextStyle& style) {
  body_ += fmt::format(R"(<text x="{0:.2f}" y="{1:.2f}" font-size="{2:.1f}" text-anchor="{3}" {4})",
                       at.x, at.y, style.size_px, anchor_name(style.anchor),
                       paint("fill", style.colour));
  if (style.bold) { body_ += R"( font-weight="bold")"; }
  if (style.upward) {
    body_ += fmt::format(" transform=\"rotate(-90 {:.2f} {:.2f})\"", at.x, at.y);
  }
  body_ += ">" + escape(words) + "</text>\n";
}

void SvgCanvas::image(const PixelBox& box, const ColourImage& pixels) {
  body_ += fmt::format(
      R"(<image x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" preserveAspectRatio="none" )"
      R"(style="image-rendering:pixelated" xlink:href="data:image/png;base64,{}"/>)"
      "\n",
      box.left, box.top, box.width, box.height, base64(encode_png(pixels, true)));
}

}  // namespace picolo::host
