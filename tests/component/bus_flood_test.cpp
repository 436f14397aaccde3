// One program that asks without a pause must not keep the daemon from its work.

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "appliance/control/bus.h"
#include "rt/clock.h"
#include "rt/unique_fd.h"
#include "tests/support/commanded_box.h"

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

/// Asks for all properties without a pause and without looking at an answer.
class Flood {
 public:
  explicit Flood(const std::string& bus)
      : thread_([this, bus](const std::stop_token& stop) {
          auto opened = appliance::openBus(bus);
          ASSERT_TRUE(opened.has_value()) << opened.error();
          while (!stop.stop_requested()) ask(opened->get());
        }) {}

  [[nodiscard]] std::uint64_t asked() const { return asked_.load(); }

 private:
  void ask(sd_bus* bus) {
    sd_bus_message* call = nullptr;
    if (sd_bus_message_new_method_call(bus, &call, "org.kagami.Kagami1", "/org/kagami/Kagami1",
                                       "org.freedesktop.DBus.Properties", "GetAll") < 0)
      return;
    sd_bus_message_append(call, "s", "org.kagami.Kagami1");
    sd_bus_message_set_expect_reply(call, 0);
    if (sd_bus_send(bus, call, nullptr) >= 0) ++asked_;
    sd_bus_message_unref(call);
    (void)sd_bus_flush(bus);
  }

  std::atomic<std::uint64_t> asked_{0};
  std::jthread thread_;
};

class BusFlood : public test::CommandedBox {
 protected:
  BusFlood() : CommandedBox({.first_address = "127.0.41.1", .cameras = 4, .wire_port = 4191}) {}
};

constexpr auto kLength = 5s;

TEST_F(BusFlood, NeitherStarvesTheWatchdogNorLosesFramesNorHidesAStopSignal) {
  NotifySocket systemd((folder() / "notify").string());
  startDaemon();
  ASSERT_TRUE(becomes([](const auto& status) { return status["shown_hz"] > 0; }));
  const std::uint64_t lost_before = status()["frames_lost"];
  std::optional<Flood> flood(busAddress());
  systemd.startWatch();
  std::this_thread::sleep_for(kLength);
  const auto gap_ms = std::chrono::duration_cast<std::chrono::milliseconds>(systemd.longestGap());
  const std::uint64_t asked = flood->asked();
  EXPECT_GT(asked, 1000U);
  // A starved loop shows a gap as long as the flood. The bar on a quiet machine is 500 ms.
  EXPECT_LT(gap_ms, kLength / 2);
  flood.reset();  // others are answered when what is queued on the bus has been
  EXPECT_TRUE(becomes([&](const auto& status) { return status["frames_lost"] == lost_before; }));

  flood.emplace(busAddress());
  std::this_thread::sleep_for(1s);
  const rt::Timestamp asked_to_stop = rt::now();
  daemon().terminate();
  ASSERT_EQ(daemon().wait(60s), 0) << daemon().output();
  ASSERT_NE(systemd.stopping(), rt::Timestamp{});
  const auto heard_ms =
      std::chrono::duration_cast<std::chrono::milliseconds>(systemd.stopping() - asked_to_stop);
  EXPECT_LT(heard_ms, kLength / 2);
  std::printf("%llu calls in %lld s: longest watchdog gap %lld ms, SIGTERM heard after %lld ms\n",
              static_cast<unsigned long long>(asked), static_cast<long long>(kLength.count()),
              static_cast<long long>(gap_ms.count()), static_cast<long long>(heard_ms.count()));
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
