// Stands at a trigger line of the kernel in place of the cameras' opto-couplers: every edge of the
// line becomes the datagram that emulated cameras fire by. Runs inside the test kernel.
//
// usage: trigger_bridge LINE WIRE_PORT [--active-low] [--loop-back FOLDER]
//   --active-low   the line's low level is the active one
//   --loop-back    also pulls the input whose gpio-sim folder this is

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/kernel/support/gpio_wire.h"

namespace {

/// Where an emulator listens for its trigger line.
class EmulatorWire {
 public:
  explicit EmulatorWire(std::uint16_t port) : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(port);
    to_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  }
  ~EmulatorWire() { ::close(fd_); }
  EmulatorWire(const EmulatorWire&) = delete;
  EmulatorWire& operator=(const EmulatorWire&) = delete;

  void send(bool rising, std::int64_t time_ns) const {
    const std::string text = (rising ? "L1+ " : "L1- ") + std::to_string(time_ns);
    if (::sendto(fd_, text.data(), text.size(), 0, reinterpret_cast<const sockaddr*>(&to_),
                 sizeof to_) < 0) {
      std::fprintf(stderr, "trigger_bridge: %s is lost: %s\n", text.c_str(), std::strerror(errno));
    }
  }

 private:
  int fd_;
  sockaddr_in to_{};
};

int usage() {
  std::fprintf(stderr,
               "usage: trigger_bridge LINE WIRE_PORT [--active-low] [--loop-back FOLDER]\n");
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 2) return usage();
  bool active_low = false;
  test::GpioWire::Receiver loop_back;
  for (std::size_t i = 2; i < words.size(); ++i) {
    if (words[i] == "--active-low") {
      active_low = true;
    } else if (words[i] == "--loop-back" && i + 1 < words.size()) {
      loop_back = test::pullOf(words[++i]);
    } else {
      return usage();
    }
  }

  sigset_t stop;
  sigemptyset(&stop);
  sigaddset(&stop, SIGTERM);
  sigaddset(&stop, SIGINT);
  pthread_sigmask(SIG_BLOCK, &stop, nullptr);
  try {
    const EmulatorWire wire(static_cast<std::uint16_t>(std::stoul(words[1])));
    const test::GpioWire line(words[0], [&](const test::GpioEvent& edge) {
      wire.send(edge.level != active_low, edge.time_ns);
      if (loop_back) loop_back(edge);
    });
    std::printf("ready\n");
    std::fflush(stdout);
    int signal = 0;
    sigwait(&stop, &signal);
  } catch (const std::exception& refused) {
    std::fprintf(stderr, "trigger_bridge: %s\n", refused.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
