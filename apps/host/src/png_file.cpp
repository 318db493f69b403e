// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <png.h>

#include <cstddef>
#include <string>
#include <vector>

#include "picolo/host/error.hpp"
#include "raster_canvas.hpp"

namespace picolo::host {
namespace {

void refuse(png_structp /*png*/, png_const_charp reason) {
  throw UserError{ExitCode::device, "", std::string{"libpng: "} + reason, "report this as a bug"};
}

void append(png_structp png, png_bytep bytes, std::size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))
      ->append(reinterpret_cast<const char*>(bytes), count);
}

struct PngWriter {
  PngWriter()
      : png{png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, refuse, nullptr)},
        info{png_create_info_struct(png)} {}
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  png_structp png;
  png_infop info;
};

}  // namespace

std::string encode_png(const ColourImage& image, bool with_alpha) {
  std::string content;
  const PngWriter writer;
  png_set_write_fn(writer.png, &content, append, nullptr);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 8,
               with_alpha ? PNG_COLOR_TYPE_RGBA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(writer.png, writer.info);
  std::vector<png_byte> line;
  for (std::size_t row = 0; row < image.height; ++row) {
    line.clear();
    for (std::size_t column = 0; column < image.width; ++column) {
      const Colour& pixel = image.pixels[row * image.width + column];
      line.insert(line.end(), {pixel.red, pixel.green, pixel.blue});
      if (with_alpha) { line.push_back(pixel.alpha); }
    }
    png_write_row(writer.png, line.data());
  }
  png_write_end(writer.png, writer.info);
  return content;
}

}  // namespace picolo::host
