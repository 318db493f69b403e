// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "platforms.hpp"

#include <sys/wait.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "support/data.hpp"

namespace picolo::target {
namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

bool names(const std::string& list, const std::string& word) {
  return ("," + list + ",").find("," + word + ",") != std::string::npos;
}

bool has_program(const std::string& program) {
  return program.empty() ||
         std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

}  // namespace

const std::vector<Platform>& platforms() {
  static const std::vector<Platform> all{
      {"x86-64 gcc -O0", "image-gcc-O0", "", ""},
      {"x86-64 gcc -O2", "image-gcc-O2", "", ""},
      {"x86-64 gcc -O3", "image-gcc-O3", "", ""},
      {"x86-64 gcc -O3 AVX2", "image-gcc-avx2", "", ""},
      {"x86-64 clang -O0", "image-clang-O0", "", ""},
      {"x86-64 clang -O2", "image-clang-O2", "", ""},
      {"x86-64 clang -O3", "image-clang-O3", "", ""},
      {"x86-64 clang -O3 AVX2", "image-clang-avx2", "", ""},
      {"aarch64 Linux", "target-aarch64", "", "qemu-aarch64"},
      // Its two CAN controllers on one bus.
      {"Cortex-A53 bare metal", "target-a53",
       "xlnx-zcu102,canbus0=can,canbus1=can -object can-bus,id=can", "qemu-system-aarch64"},
      {"Cortex-M7", "target-m7", "mps2-an500", "qemu-system-arm"},
      {"Cortex-M55", "target-m55", "mps3-an547", "qemu-system-arm"},
      {"Cortex-M4F", "target-m4f", "mps2-an386", "qemu-system-arm"},
  };
  return all;
}

std::filesystem::path build_tree(const Platform& platform) {
  return test::source_dir() / "build" / platform.preset;
}

std::filesystem::path image(const Platform& platform, const std::string& name) {
  return build_tree(platform) / "images" / (name + ".elf");
}

std::vector<Platform> platforms_to_judge() {
  const std::string asked = environment("PICOLO_TARGETS");
  std::vector<Platform> chosen;
  for (const Platform& platform : platforms()) {
    const bool there =
        std::filesystem::exists(image(platform, "determinism")) && has_program(platform.program);
    if (asked.empty() ? there : asked == "all" || names(asked, platform.preset)) {
      chosen.push_back(platform);
    }
  }
  return chosen;
}

std::string nothing_to_judge() {
  if (!platforms_to_judge().empty()) { return ""; }
  return "no image was built: ./run targets installs arm-none-eabi and QEMU and builds them";
}

bool required() {
  return test::group_is_required("arm");
}

Figures figures_in(const std::string& text) {
  Figures figures;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name;
    std::int64_t value = 0;
    if (words >> name >> value) { figures[name] = value; }
  }
  return figures;
}

Outcome run(const std::string& command) {
  Outcome outcome;
  const auto start = std::chrono::steady_clock::now();
  std::FILE* pipe = popen((command + " 2>&1 </dev/null").c_str(), "r");
  if (pipe == nullptr) { return outcome; }
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    outcome.output.append(buffer.data(), count);
  }
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return outcome;
}

Outcome run(const Platform& platform, const std::string& image_name,
            const std::vector<std::string>& words, const std::string& extra) {
  const std::string file = image(platform, image_name).string();
  std::string command = "QEMU_AUDIO_DRV=none timeout 600 ";
  if (platform.machine.empty()) {
    if (!platform.program.empty()) { command += platform.program + " "; }
    command += file;
    for (const std::string& word : words) { command += " '" + word + "'"; }
    return run(command);
  }
  command += platform.program + " -M " + platform.machine + " -display none -monitor none " +
             extra + (extra.find("-serial") == std::string::npos ? " -serial null" : "") +
             " -semihosting-config enable=on,target=native";
  if (!words.empty()) { command += ",arg=" + image_name; }
  for (const std::string& word : words) { command += ",arg='" + word + "'"; }
  command += platform.machine.starts_with("xlnx") ? " -device loader,file=" + file + ",cpu-num=0"
                                                  : " -kernel " + file;
  return run(command);
}

}  // namespace picolo::target
