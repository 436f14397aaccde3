#pragma once

#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace test {

/// A message bus of its own for one test: the real dbus-daemon, without any service.
class PrivateBus {
 public:
  /// At an address of its own, or at @p address, which another one has left.
  explicit PrivateBus(const std::string& address = "")
      : PrivateBus(std::vector<std::string>{"--session"}, address) {}

  /// With @p options in place of the session's configuration.
  explicit PrivateBus(std::vector<std::string> options, const std::string& address = "") {
    options.insert(options.begin(), "dbus-daemon");
    if (!address.empty()) options.push_back("--address=" + address);
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return;
    pid_ = fork();
    if (pid_ == 0) {
      if (freopen("/dev/null", "w", stderr) == nullptr)
        _exit(127);  // it complains of limits that it does not need
      options.insert(options.end(),
                     {"--nofork", "--nopidfile", "--print-address=" + std::to_string(ends[1])});
      std::vector<char*> argv;
      for (std::string& option : options) argv.push_back(option.data());
      argv.push_back(nullptr);
      execvp("dbus-daemon", argv.data());
      _exit(127);
    }
    close(ends[1]);
    char c = 0;
    while (read(ends[0], &c, 1) == 1 && c != '\n') address_ += c;
    close(ends[0]);
    address_ = address_.substr(0, address_.find(",guid="));  // holds for the next bus there, too
  }
  PrivateBus(const PrivateBus&) = delete;
  PrivateBus& operator=(const PrivateBus&) = delete;
  ~PrivateBus() { stop(); }

  void stop() {
    if (pid_ <= 0) return;
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }

  /// Empty where there is no dbus-daemon to start.
  [[nodiscard]] const std::string& address() const { return address_; }

 private:
  pid_t pid_ = -1;
  std::string address_;
};

}  // namespace test
