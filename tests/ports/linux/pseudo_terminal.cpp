// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "pseudo_terminal.hpp"

#include <fcntl.h>
#include <pty.h>
#include <stdlib.h>
#include <unistd.h>

#include <stdexcept>
#include <string>

namespace picolo::test {

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "picolo-ports-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) { throw std::runtime_error("no temporary folder"); }
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void PseudoTerminal::plug() {
  int master = -1;
  int slave = -1;
  std::array<char, 128> name{};
  if (::openpty(&master, &slave, name.data(), nullptr, nullptr) != 0) {
    throw std::runtime_error("no pseudo-terminal: is /dev/pts mounted?");
  }
  ::close(slave);
  ::fcntl(master, F_SETFL, O_NONBLOCK);
  master_ = FileDescriptor{master};
  std::filesystem::remove(path());
  std::filesystem::create_symlink(name.data(), path());
}

void PseudoTerminal::unplug() {
  master_.close();
  std::filesystem::remove(path());
}

bool PseudoTerminal::send(std::span<const std::uint8_t> bytes) const {
  return ::write(master_.get(), bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
}

std::size_t PseudoTerminal::receive(std::span<std::uint8_t> buffer) const {
  const ssize_t count = ::read(master_.get(), buffer.data(), buffer.size());
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

}  // namespace picolo::test
