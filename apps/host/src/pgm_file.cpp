// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "pgm_file.hpp"

#include <fmt/format.h>

#include <cctype>
#include <string>

#include "picolo/host/error.hpp"
#include "picolo/host/files.hpp"

namespace picolo::host {
namespace {

constexpr std::size_t kMaxSide = 32'768;

class PgmText {
 public:
  PgmText(std::string name, std::string bytes) : name_{std::move(name)}, bytes_{std::move(bytes)} {}

  [[noreturn]] void refuse(const std::string& cause) const {
    throw UserError{ExitCode::input, name_, cause,
                    "a map's image is a PGM file; 'convert map.png map.pgm' makes one"};
  }
  [[nodiscard]] char kind() {
    if (bytes_.size() < 3 || bytes_[0] != 'P' || (bytes_[1] != '2' && bytes_[1] != '5')) {
      refuse("is no PGM file (it does not begin with P2 or P5)");
    }
    at_ = 2;
    return bytes_[1];
  }
  [[nodiscard]] std::size_t number(const char* what, std::size_t most) {
    skip_space();
    std::size_t value = 0;
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && std::isdigit(static_cast<unsigned char>(bytes_[at_])) != 0) {
      value = value * 10 + static_cast<std::size_t>(bytes_[at_] - '0');
      ++at_;
      if (value > most) { refuse(fmt::format("its {} is above {}", what, most)); }
    }
    if (begin == at_) { refuse(fmt::format("ends or is damaged where its {} should stand", what)); }
    return value;
  }
  /// After the single white space behind the header.
  [[nodiscard]] std::string_view pixels() const {
    return std::string_view{bytes_}.substr(std::min(bytes_.size(), at_ + 1));
  }

 private:
  void skip_space() {
    while (at_ < bytes_.size()) {
      if (bytes_[at_] == '#') {
        while (at_ < bytes_.size() && bytes_[at_] != '\n') { ++at_; }
      } else if (std::isspace(static_cast<unsigned char>(bytes_[at_])) != 0) {
        ++at_;
      } else {
        return;
      }
    }
  }

  std::string name_;
  std::string bytes_;
  std::size_t at_ = 0;
};

}  // namespace

GreyImage read_pgm(const std::filesystem::path& path) {
  PgmText text{path.string(), read_file(path, "the YAML file names its image relative to itself")};
  const char kind = text.kind();
  GreyImage image;
  image.width = text.number("width", kMaxSide);
  image.height = text.number("height", kMaxSide);
  image.white = static_cast<int>(text.number("largest grey", 65'535));
  if (image.width == 0 || image.height == 0 || image.white == 0) { text.refuse("is empty"); }
  const std::size_t count = image.width * image.height;
  image.greys.reserve(count);
  const auto white = static_cast<std::size_t>(image.white);
  if (kind == '2') {
    for (std::size_t k = 0; k < count; ++k) {
      image.greys.push_back(static_cast<int>(text.number("grey", white)));
    }
    return image;
  }
  const std::string_view pixels = text.pixels();
  const std::size_t size = image.white < 256 ? 1 : 2;
  if (pixels.size() < count * size) {
    text.refuse(fmt::format("holds {} bytes of pixels instead of {}", pixels.size(), count * size));
  }
  for (std::size_t k = 0; k < count; ++k) {
    int grey = static_cast<unsigned char>(pixels[k * size]);
    if (size == 2) { grey = grey * 256 + static_cast<unsigned char>(pixels[k * size + 1]); }
    if (grey > image.white) { text.refuse("has a grey above its largest"); }
    image.greys.push_back(grey);
  }
  return image;
}

}  // namespace picolo::host
