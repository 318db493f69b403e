// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The repository as the layout tests see it: files, their lines, their code without comments.
#pragma once

#include <string>
#include <vector>

namespace picolo::layout {

struct Include {
  int line = 0;
  std::string target;   ///< as written, without the brackets or quotes
  bool system = false;  ///< <...>
};

struct SourceFile {
  std::string path;                ///< relative to the root of the tree, with '/'
  std::vector<std::string> lines;  ///< as they are
  std::vector<std::string> code;   ///< comments, strings and character literals blanked out
  std::vector<Include> includes;
};

struct Violation {
  std::string path;
  int line = 0;
  std::string rule;
};

/// Cuts `text` into lines and finds its includes.
SourceFile parse_source(const std::string& path, const std::string& text);

/// Every .cpp and .hpp below the code folders of the tree at test::source_dir().
const std::vector<SourceFile>& source_tree();

/// CMakeLists.txt, *.cmake and scripts of the tree.
std::vector<SourceFile> build_files();

bool starts_with_folder(const std::string& path, const std::string& folder);
bool is_header(const SourceFile& file);
/// A header that customers compile: it lies below an include/ folder of the shipped packages.
bool is_public_header(const SourceFile& file);
/// firmware_lib, hal, drivers, controller: what also runs on bare metal.
bool is_firmware(const SourceFile& file);

}  // namespace picolo::layout
