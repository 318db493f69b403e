// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "stroke_font.hpp"

#include <array>
#include <cstddef>

namespace picolo::host {
namespace {

/// Points are two characters, x and y + 4 in base 36; strokes are separated by blanks; a stroke
/// that begins with '~' is the control polygon of a curve.
struct GlyphCode {
  int width;
  std::string_view strokes;
};

constexpr char kFirst = ' ';
constexpr std::array<GlyphCode, 95> kGlyphs{{
    {4, ""},                                               //
    {0, "0i08 0405"},                                      // !
    {2, "0i0f 2i2f"},                                      // "
    {8, "143i 547i 0888 0d8d"},                            // #
    {8, "~8g6i2i0g0d2b6b8986642406 4k42"},                 // $
    {8, "048i ~0g1i2i3g2e1e0g ~56687886746456"},           // %
    {8, "~841f3i5f0724548a"},                              // &
    {0, "0i0f"},                                           // '
    {3, "~3j0e0632"},                                      // (
    {3, "~0j3e3602"},                                      // )
    {6, "0f6b 0b6f 3g3a"},                                 // *
    {6, "0969 3c36"},                                      // +
    {1, "1503"},                                           // ,
    {5, "0959"},                                           // -
    {0, "0405"},                                           // .
    {6, "026i"},                                           // /
    {7, "~2i5i7f775424070f2i"},                            // 0
    {7, "1f4i44"},                                         // 1
    {7, "~0f1i6i7e6b04 0474"},                             // 2
    {7, "~0g2i5i7g7d5b2b ~2b5b7876542406"},                // 3
    {7, "646i0888"},                                       // 4
    {7, "7i1i0c ~0c2d5d7b76542406"},                       // 5
    {7, "~2d5d7b765424060b2d ~6i3h0e08"},                  // 6
    {7, "0i7i24"},                                         // 7
    {7, "~2i5i6g6d5b2b1d1g2i ~2b5b7976542406092b"},        // 8
    {7, "~2i5i7g7c5a2a0c0g2i ~7e795414"},                  // 9
    {0, "0405 0c0d"},                                      // :
    {1, "1503 1c1d"},                                      // ;
    {6, "6d0965"},                                         // <
    {6, "0767 0b6b"},                                      // =
    {6, "0d6905"},                                         // >
    {7, "~0f2i5i7g7d4b48 4445"},                           // ?
    {10, "~7c5d3c365476 7d76 ~7686a8 ~a8af7i3i0f072362"},  // @
    {8, "044i84 1878"},                                    // A
    {8, "040i ~0i4i7i7b4b0b ~0b5b8b845404"},               // B
    {8, "~8g6i2i0f07246486"},                              // C
    {8, "040i ~0i4i8h8b854404"},                           // D
    {7, "7i0i0474 0b6b"},                                  // E
    {7, "7i0i04 0b6b"},                                    // F
    {8, "~8g6i2i0f07246486 868b5b"},                       // G
    {8, "040i 848i 0b8b"},                                 // H
    {0, "040i"},                                           // I
    {5, "~5i5c56441406"},                                  // J
    {8, "040i 8i09 3c84"},                                 // K
    {7, "0i0474"},                                         // L
    {10, "040i57aia4"},                                    // M
    {8, "040i848i"},                                       // N
    {8, "~2i6i8f876424070f2i"},                            // O
    {8, "040i ~0i4i8i8a4a0a"},                             // P
    {8, "~2i6i8f876424070f2i 5883"},                       // Q
    {8, "040i ~0i4i8i8a4a0a 4a84"},                        // R
    {8, "~8g6i2i0g0d2b6b8986642406"},                      // S
    {8, "0i8i 4i44"},                                      // T
    {8, "~0i0b072464878b8i"},                              // U
    {8, "0i448i"},                                         // V
    {12, "0i346g94ci"},                                    // W
    {8, "048i 0i84"},                                      // X
    {8, "0i4b8i 4b44"},                                    // Y
    {8, "0i8i0484"},                                       // Z
    {3, "3j0j0232"},                                       // [
    {6, "0i62"},                                           // backslash
    {3, "0j3j3202"},                                       // ]
    {6, "0d3i6d"},                                         // ^
    {7, "0272"},                                           // _
    {2, "0i2f"},                                           // `
    {7, "7e74 ~7c5e2e0c06245476"},                         // a
    {7, "0i04 ~0c2e5e7c76542406"},                         // b
    {7, "~7c5e2e0c06245476"},                              // c
    {7, "7i74 ~7c5e2e0c06245476"},                         // d
    {7, "0979 ~797c5e2e0c06245476"},                       // e
    {5, "~5i3i2g2d24 0e5e"},                               // f
    {7, "~7e7571502001 ~7c5e2e0c06245476"},                // g
    {7, "040i ~0b2e5e7c7a74"},                             // h
    {0, "0e04 0h0i"},                                      // i
    {2, "~2e252100 2h2i"},                                 // j
    {7, "040i 7e08 3a74"},                                 // k
    {0, "0i04"},                                           // l
    {10, "0e04 ~0b2e4e5c5a54 ~5b7e9eacaaa4"},              // m
    {7, "0e04 ~0b2e5e7c7a74"},                             // n
    {7, "~2e5e7c765424060c2e"},                            // o
    {7, "0e00 ~0c2e5e7c76542406"},                         // p
    {7, "7e70 ~7c5e2e0c06245476"},                         // q
    {5, "0e04 ~0a1d3e5e"},                                 // r
    {6, "~6c4e2e0c0a29496866442406"},                      // s
    {5, "~2h273454 0e5e"},                                 // t
    {7, "7e74 ~0e07245477"},                               // u
    {6, "0e346e"},                                         // v
    {10, "0e345d74ae"},                                    // w
    {6, "046e 0e64"},                                      // x
    {6, "0e34 6e10"},                                      // y
    {6, "0e6e0464"},                                       // z
    {4, "~4j2j2c0a282141"},                                // {
    {0, "000j"},                                           // |
    {4, "~0j2j2c4a282101"},                                // }
    {8, "~081b3b57778a"},                                  // ~
}};
constexpr GlyphCode kMissing{6, "040i6i6404"};
constexpr double kGap = 3.4;

double digit(char code) {
  return code <= '9' ? code - '0' : code - 'a' + 10;
}

/// Chaikin's corner cutting: a quadratic B-spline in the limit, ends kept.
std::vector<Pixel> smooth(const std::vector<Pixel>& polygon) {
  const bool closed =
      polygon.front().x == polygon.back().x && polygon.front().y == polygon.back().y;
  std::vector<Pixel> cut;
  if (!closed) { cut.push_back(polygon.front()); }
  for (std::size_t i = 0; i + 1 < polygon.size(); ++i) {
    const Pixel& a = polygon[i];
    const Pixel& b = polygon[i + 1];
    cut.push_back({0.75 * a.x + 0.25 * b.x, 0.75 * a.y + 0.25 * b.y});
    cut.push_back({0.25 * a.x + 0.75 * b.x, 0.25 * a.y + 0.75 * b.y});
  }
  cut.push_back(closed ? cut.front() : polygon.back());
  return cut;
}

std::vector<Pixel> decode(std::string_view code) {
  const bool curve = code.front() == '~';
  std::vector<Pixel> stroke;
  for (std::size_t i = curve ? 1 : 0; i + 1 < code.size(); i += 2) {
    stroke.push_back({digit(code[i]), digit(code[i + 1]) - 4.0});
  }
  return curve ? smooth(smooth(smooth(stroke))) : stroke;
}

GlyphCode find(char character) {
  const int index = character - kFirst;
  return index >= 0 && index < static_cast<int>(kGlyphs.size())
             ? kGlyphs[static_cast<std::size_t>(index)]
             : kMissing;
}

}  // namespace

Glyph stroke_glyph(char character) {
  const GlyphCode code = find(character);
  Glyph glyph{{}, code.width + kGap};
  std::string_view rest = code.strokes;
  while (!rest.empty()) {
    const std::size_t end = rest.find(' ');
    glyph.strokes.push_back(decode(rest.substr(0, end)));
    rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
  }
  return glyph;
}

double text_width(std::string_view words, double size_px) {
  double width = 0.0;
  for (const char character : words) { width += find(character).width + kGap; }
  return width * size_px * kCapPerSize / kCapHeight;
}

}  // namespace picolo::host
