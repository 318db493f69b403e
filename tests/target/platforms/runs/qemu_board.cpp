// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "qemu_board.hpp"

#include <poll.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): kill
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

namespace picolo::target {
namespace {

constexpr int kPatience_ms = 60'000;

FileDescriptor listen_at(const std::filesystem::path& path) {
  FileDescriptor listener{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  const void* any = &address;
  static_cast<void>(::bind(listener.get(), static_cast<const sockaddr*>(any), sizeof address) ==
                        0 &&
                    ::listen(listener.get(), 1) == 0);
  return listener;
}

FileDescriptor accept_from(const FileDescriptor& listener) {
  pollfd wait{.fd = listener.get(), .events = POLLIN, .revents = 0};
  if (::poll(&wait, 1, kPatience_ms) != 1) { return FileDescriptor{}; }
  return FileDescriptor{::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK)};
}

}  // namespace

QemuBoard::QemuBoard(const Platform& platform, const std::string& image_name,
                     const std::vector<std::string>& words, const std::string& options) {
  std::string name = (std::filesystem::temp_directory_path() / "picolo-XXXXXX").string();
  folder_ = ::mkdtemp(name.data()) == nullptr ? "" : name;
  std::string command = "exec " + platform.program + " -M " + platform.machine + " " + options +
                        " -display none -monitor none -semihosting-config "
                        "enable=on,target=native,arg=" +
                        image_name;
  for (const std::string& word : words) { command += ",arg=" + word; }
  std::vector<FileDescriptor> listeners;
  for (std::size_t i = 0; i < kUarts; ++i) {
    const std::filesystem::path path = folder_ / ("uart" + std::to_string(i));
    listeners.push_back(listen_at(path));
    command += " -serial unix:" + path.string();
  }
  command += " -kernel '" + image(platform, image_name).string() + "' </dev/null >'" +
             (folder_ / "output").string() + "' 2>&1";
  pid_ = ::fork();
  if (pid_ == 0) {
    ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    ::_exit(127);
  }
  for (std::size_t i = 0; i < kUarts; ++i) {
    uarts_[i] = accept_from(listeners[i]);
    if (!uarts_[i].is_open()) { return; }
  }
}

QemuBoard::~QemuBoard() {
  if (pid_ > 0) { ::kill(pid_, SIGKILL); }
  static_cast<void>(finish());
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

bool QemuBoard::wait_for(std::span<const std::size_t> uarts) {
  std::vector<pollfd> waits;
  for (const std::size_t uart : uarts) {
    waits.push_back({.fd = uarts_[uart].get(), .events = POLLIN, .revents = 0});
  }
  const int ready = ::poll(waits.data(), waits.size(), kPatience_ms);
  if (ready <= 0) { return false; }
  for (const pollfd& wait : waits) {
    std::uint8_t byte = 0;
    const bool over = (wait.revents & POLLIN) != 0 && ::recv(wait.fd, &byte, 1, MSG_PEEK) == 0;
    if (over || (wait.revents & (POLLERR | POLLNVAL)) != 0) { return false; }
  }
  return true;
}

std::size_t QemuBoard::receive(std::size_t uart, std::span<std::uint8_t> buffer) {
  const ssize_t count = ::read(uarts_[uart].get(), buffer.data(), buffer.size());
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

void QemuBoard::send(std::size_t uart, std::span<const std::uint8_t> bytes) {
  const ssize_t count =
      ::send(uarts_[uart].get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  not_sent_ += bytes.size() - (count > 0 ? static_cast<std::size_t>(count) : 0);
}

Outcome QemuBoard::finish() {
  Outcome outcome;
  if (pid_ <= 0) { return outcome; }
  int status = 0;
  for (int i = 0; i < 1000 && ::waitpid(pid_, &status, WNOHANG) == 0; ++i) {
    if (i == 999) { ::kill(pid_, SIGKILL); }
    ::usleep(10'000);
  }
  static_cast<void>(::waitpid(pid_, &status, 0));  // the killed one
  pid_ = -1;
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  std::ostringstream text;
  text << std::ifstream{folder_ / "output"}.rdbuf();
  outcome.output = text.str();
  return outcome;
}

}  // namespace picolo::target
