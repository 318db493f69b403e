// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <cstring>
#include <map>
#include <sstream>

#include "byte_source.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/lidar_scans3.hpp"

namespace picolo::host {
namespace {

std::string whole(const std::filesystem::path& path) {
  ByteSource source{path.string()};
  std::string bytes;
  while (source.append_to(bytes)) {}
  return bytes;
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& cause) {
  throw UserError{ExitCode::input, path.string(), cause,
                  "give an ascii or binary little-endian PLY with float x, y, z"};
}

const std::map<std::string, std::size_t> kSizes{
    {"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},  {"short", 2}, {"ushort", 2},
    {"int16", 2}, {"uint16", 2},  {"int", 4},    {"uint", 4},   {"int32", 4}, {"uint32", 4},
    {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};

struct PlyHeader {
  bool ascii = false;
  std::size_t vertices = 0;
  std::size_t stride = 0;  ///< bytes, or fields of ascii
  std::size_t fields = 0;
  std::array<std::size_t, 3> offset{};  ///< bytes
  std::array<std::size_t, 3> field{};
  std::array<std::size_t, 3> size{};  ///< 0: not there
  std::size_t body = 0;
};

PlyHeader parse_header(const std::string& bytes, const std::filesystem::path& path) {
  const std::size_t end = bytes.find("end_header\n");
  if (!bytes.starts_with("ply") || end == std::string::npos) { refuse(path, "is no PLY file"); }
  PlyHeader header;
  header.body = end + 11;
  std::istringstream lines{bytes.substr(0, end)};
  std::string line;
  bool in_vertex = false;
  while (std::getline(lines, line)) {
    std::istringstream words{line};
    std::string word;
    std::string type;
    std::string name;
    words >> word >> type >> name;
    if (word == "format") {
      if (type != "ascii" && type != "binary_little_endian") {
        refuse(path, "is of format " + type);
      }
      header.ascii = type == "ascii";
    } else if (word == "element") {
      in_vertex = type == "vertex";
      if (in_vertex) { header.vertices = std::stoul(name); }
    } else if (word == "property" && in_vertex) {
      const auto size = kSizes.find(type);
      if (size == kSizes.end()) { refuse(path, "has a vertex property of type " + type); }
      const std::size_t axis = name == "x" ? 0 : name == "y" ? 1 : name == "z" ? 2 : 3;
      if (axis < 3) {
        header.offset[axis] = header.stride;
        header.field[axis] = header.fields;
        header.size[axis] = size->second;
      }
      header.stride += size->second;
      ++header.fields;
    }
  }
  for (const std::size_t size : header.size) {
    if (size != 4 && size != 8) { refuse(path, "has no float x, y and z"); }
  }
  return header;
}

float real_at(const std::string& bytes, std::size_t at, std::size_t size) {
  if (size == 4) {
    float value{};
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  }
  double value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return static_cast<float>(value);
}

}  // namespace

std::vector<Vector3f> read_ply(const std::filesystem::path& path) {
  const std::string bytes = whole(path);
  const PlyHeader header = parse_header(bytes, path);
  std::vector<Vector3f> points;
  if (header.ascii) {
    std::istringstream numbers{bytes.substr(header.body)};
    std::vector<float> row(header.fields);
    for (std::size_t i = 0; i < header.vertices; ++i) {
      for (float& value : row) { numbers >> value; }
      if (!numbers) { refuse(path, fmt::format("ends after {} of {} points", i, header.vertices)); }
      points.push_back({row[header.field[0]], row[header.field[1]], row[header.field[2]]});
    }
    return points;
  }
  if (bytes.size() < header.body + header.vertices * header.stride) {
    refuse(path, fmt::format("is cut: {} bytes for {} points", bytes.size(), header.vertices));
  }
  for (std::size_t i = 0; i < header.vertices; ++i) {
    const std::size_t at = header.body + i * header.stride;
    points.push_back({real_at(bytes, at + header.offset[0], header.size[0]),
                      real_at(bytes, at + header.offset[1], header.size[1]),
                      real_at(bytes, at + header.offset[2], header.size[2])});
  }
  return points;
}

std::vector<Vector3f> read_float_points(const std::filesystem::path& path, std::size_t fields) {
  const std::string bytes = whole(path);
  const std::size_t stride = fields * sizeof(float);
  if (bytes.empty() || bytes.size() % stride != 0) {
    throw UserError{ExitCode::input, path.string(),
                    fmt::format("its {} bytes are no whole number of points of {} floats",
                                bytes.size(), fields),
                    "get a whole copy"};
  }
  std::vector<Vector3f> points;
  for (std::size_t at = 0; at < bytes.size(); at += stride) {
    points.push_back({real_at(bytes, at, 4), real_at(bytes, at + 4, 4), real_at(bytes, at + 8, 4)});
  }
  return points;
}

}  // namespace picolo::host
