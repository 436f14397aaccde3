// One program that asks without a pause must not keep the daemon from its work.

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "appliance/control/bus.h"
#include "rt/clock.h"
#include "rt/unique_fd.h"
#include "tests/support/child_process.h"
#include "tests/support/commanded_box.h"
#include "tests/support/policed_bus.h"

namespace {

using namespace std::chrono_literals;

/// systemd's end of sd_notify(): notes when the messages came.
class NotifySocket {
 public:
  explicit NotifySocket(const std::string& path)
      : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    EXPECT_EQ(bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    const timeval patience{.tv_sec = 0, .tv_usec = 100'000};
    setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) listen();
    });
  }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;
  ~NotifySocket() { unsetenv("NOTIFY_SOCKET"); }

  /// Begins to measure.
  void startWatch() {
    const std::scoped_lock lock(mutex_);
    last_watchdog_ = rt::now();
    longest_gap_ = {};
  }
  [[nodiscard]] rt::Nanoseconds longestGap() {
    const std::scoped_lock lock(mutex_);
    return std::max(longest_gap_, rt::now() - last_watchdog_);
  }
  /// When the daemon said that it stops; the epoch: not yet.
  [[nodiscard]] rt::Timestamp stopping() {
    const std::scoped_lock lock(mutex_);
    return stopping_;
  }

 private:
  void listen() {
    std::array<char, 4096> message{};
    const auto length = recv(socket_.get(), message.data(), message.size(), 0);
    if (length <= 0) return;
    const std::string text(message.data(), static_cast<std::size_t>(length));
    const std::scoped_lock lock(mutex_);
    const rt::Timestamp now = rt::now();
    if (text.find("STOPPING=1") != std::string::npos) stopping_ = now;
    if (text.find("WATCHDOG=1") == std::string::npos) return;
    longest_gap_ = std::max(longest_gap_, now - last_watchdog_);
    last_watchdog_ = now;
  }

  rt::UniqueFd socket_;
  std::mutex mutex_;
  rt::Timestamp last_watchdog_;
  rt::Nanoseconds longest_gap_{};
  rt::Timestamp stopping_;
  std::jthread thread_;
};

/// `bus_flooder` as @p user; empty: as the user of the test.
class Flood {
 public:
  Flood(const std::string& bus, const std::string& user, const std::filesystem::path& output)
      : program_(commandOf(bus, user), output) {}

  /// How the first call was answered: "answered", or the name of an error.
  [[nodiscard]] std::string firstAnswer() {
    return program_.waitForOutput("\n", 30s) ? textAfter("first call: ") : program_.output();
  }
  /// Ends it: how often it asked.
  [[nodiscard]] std::uint64_t end() {
    program_.terminate();
    EXPECT_EQ(program_.wait(30s), 0) << program_.output();
    return std::strtoull(textAfter("calls: ").c_str(), nullptr, 10);
  }

 private:
  static std::vector<std::string> commandOf(const std::string& bus, const std::string& user) {
    std::vector<std::string> command{BUS_FLOODER, bus};
    if (!user.empty()) command.push_back(user);
    return command;
  }
  /// The rest of the line.
  [[nodiscard]] std::string textAfter(const std::string& words) const {
    std::string output = program_.output();
    const std::size_t at = output.find(words);
    if (at == std::string::npos) return output;
    const std::size_t begin = at + words.size();
    return output.substr(begin, output.find('\n', begin) - begin);
  }

  test::ChildProcess program_;
};

constexpr auto kLength = 10s;
constexpr rt::Nanoseconds kMuchTooLong = 2500ms;

std::int64_t ms(rt::Nanoseconds time) {
  return std::chrono::duration_cast<std::chrono::milliseconds>(time).count();
}

std::uint64_t countOf(const nlohmann::json& value) {
  return value.get<std::uint64_t>();
}

std::uint64_t stallsOf(const nlohmann::json& status) {
  return countOf(status["metrics"]["machine.stalls"]);
}

/// Other users can be tried by root only; anybody else floods as the own user, who has every right.
class BusFlood : public test::CommandedBox {
 protected:
  BusFlood()
      : CommandedBox({.first_address = "127.0.41.1", .cameras = 4, .wire_port = 4191},
                     isRoot() ? test::BusKind::kPoliced : test::BusKind::kOwnUser) {}

  static bool isRoot() { return geteuid() == 0; }

  /// Floods as @p user, and stops the daemon while the flood goes on.
  void withstands(const std::string& user, const std::string& first_answer) {
    NotifySocket systemd((folder() / "notify").string());
    startDaemon();
    ASSERT_TRUE(becomes([](const auto& status) { return status["shown_hz"] > 0; }));
    const auto before = status();
    std::optional<Flood> flood;
    flood.emplace(busAddress(), user, folder() / "flooder.log");
    ASSERT_EQ(flood->firstAnswer(), first_answer);
    systemd.startWatch();
    std::this_thread::sleep_for(kLength);
    const rt::Nanoseconds gap = systemd.longestGap();
    const std::uint64_t calls = flood->end();
    EXPECT_GT(calls, 1000U);
    // A starved loop shows a gap as long as the flood. The bar on a quiet machine is 500 ms.
    EXPECT_LT(gap, kMuchTooLong);
    // Others are answered when what is queued on the bus has been. What was lost while the machine
    // itself stood still is no fault of the flood.
    std::uint64_t lost = 0;
    bool stood_still = false;
    EXPECT_TRUE(becomes([&](const auto& status) {
      lost = countOf(status["frames_lost"]) - countOf(before["frames_lost"]);
      stood_still = stallsOf(status) > stallsOf(before);
      return lost == 0 || stood_still;
    }));

    flood.emplace(busAddress(), user, folder() / "flooder.log");
    ASSERT_EQ(flood->firstAnswer(), first_answer);
    std::this_thread::sleep_for(1s);
    const rt::Timestamp asked_to_stop = rt::now();
    daemon().terminate();
    ASSERT_EQ(daemon().wait(60s), 0) << daemon().output();
    ASSERT_NE(systemd.stopping(), rt::Timestamp{});
    const rt::Nanoseconds heard = systemd.stopping() - asked_to_stop;
    EXPECT_LT(heard, kMuchTooLong);  // the bar on a quiet machine is 1 s
    std::printf(
        "%llu calls in %lld s as user \"%s\": longest watchdog gap %lld ms, SIGTERM heard after "
        "%lld ms, %llu frames lost%s\n",
        static_cast<unsigned long long>(calls), static_cast<long long>(kLength.count()),
        user.empty() ? "of the test" : user.c_str(), static_cast<long long>(ms(gap)),
        static_cast<long long>(ms(heard)), static_cast<unsigned long long>(lost),
        stood_still ? " (this PC stood still meanwhile)" : "");
  }
};

TEST_F(BusFlood, OfAViewerNeitherStarvesTheWatchdogNorLosesFramesNorHidesAStopSignal) {
  withstands(isRoot() ? test::kViewer : "", "answered");
}

TEST_F(BusFlood, OfAUserWithoutARightIsRefusedByTheBus) {
  if (!isRoot()) GTEST_SKIP() << "another user's calls can be made by root only";
  withstands(test::kAnybodyElse, SD_BUS_ERROR_ACCESS_DENIED);
}

TEST_F(BusFlood, TwentyFreezesAtOnceLeaveThePictureFrozen) {
  startDaemon();
  ASSERT_TRUE(becomes([](const auto& status) { return status["shown_hz"] > 0; }));
  auto bus = appliance::openBus(busAddress());
  ASSERT_TRUE(bus.has_value()) << bus.error();
  for (int time = 0; time < 20; ++time) {
    sd_bus_message* call = nullptr;
    ASSERT_GE(sd_bus_message_new_method_call(bus->get(), &call, "org.kagami.Kagami1",
                                             "/org/kagami/Kagami1", "org.kagami.Kagami1.Control",
                                             "Freeze"),
              0);
    sd_bus_message_set_expect_reply(call, 0);
    EXPECT_GE(sd_bus_send(bus->get(), call, nullptr), 0);
    sd_bus_message_unref(call);
  }
  (void)sd_bus_flush(bus->get());
  EXPECT_EQ(kagami({"freeze"}).exit_status, 0);  // the last one is answered
  EXPECT_EQ(status()["mode"], "frozen");
}

}  // namespace
