#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "appliance/director/director.h"

namespace director_test {

using appliance::Command;
using appliance::CommandOutcome;
using appliance::Director;
using appliance::DirectorParameters;
using appliance::Mode;
using appliance::Shot;
using appliance::StoredRange;
using appliance::StoredViews;
using appliance::Substitute;
using enum appliance::Command::Kind;
using std::chrono::milliseconds;
using std::chrono::seconds;

inline constexpr rt::Nanoseconds kPeriod = milliseconds(25);
inline constexpr std::uint32_t kSets = 300;

/// A history of five cameras that store every trigger, unless a test takes something away.
class FakeHistory : public StoredViews {
 public:
  [[nodiscard]] std::uint32_t cameras() const noexcept override { return 5; }
  [[nodiscard]] StoredRange range(std::uint32_t camera) const noexcept override {
    const std::uint64_t last = newest_of[camera] != 0 ? newest_of[camera] : newest;
    if (last == 0 || empty.contains(camera)) return {};
    return {last > kSets ? last - kSets + 1 : 1, last};
  }
  [[nodiscard]] bool holds(std::uint32_t camera, std::uint64_t trigger) const noexcept override {
    const StoredRange stored = range(camera);
    if (held != 0 && trigger == held) return true;
    return !stored.empty() && trigger >= stored.oldest && trigger <= stored.newest &&
           !holes.contains({camera, trigger});
  }
  [[nodiscard]] bool living(std::uint32_t camera) const noexcept override {
    return !lost.contains(camera);
  }

  [[nodiscard]] bool sees(std::uint32_t camera) const noexcept override {
    return !blind.contains(camera);
  }
  [[nodiscard]] std::uint64_t heldTrigger() const noexcept override { return held; }

  std::uint64_t newest = 1000;
  std::uint64_t held = 0;
  std::set<std::uint32_t> blind;
  std::array<std::uint64_t, 5> newest_of{};  // where it differs
  std::set<std::uint32_t> lost;
  std::set<std::uint32_t> empty;
  std::set<std::pair<std::uint32_t, std::uint64_t>> holes;
};

class DirectorOnAnArcOfFive : public testing::Test {
 protected:
  Shot tick(std::initializer_list<Command> commands = {}, rt::Nanoseconds passed = kPeriod) {
    now += passed;
    return director.tick({.at = now}, kPeriod, history, std::vector<Command>(commands));
  }
  Shot press(Command::Kind kind) { return tick({Command{.kind = kind}}); }
  Shot setView(std::uint32_t camera) { return tick({Command{.kind = kSetView, .camera = camera}}); }
  Shot setDelay(rt::Nanoseconds delay) {
    return tick({Command{.kind = kSetDelay, .delay = delay}});
  }

  FakeHistory history;
  Director director{
      DirectorParameters{.first_view = 2,
                         .delay_ladder = {milliseconds(500), seconds(1), seconds(2), seconds(3),
                                          seconds(5), seconds(7), seconds(10)}}};
  rt::Timestamp now = rt::fromNs(1'000'000'000);
};

}  // namespace director_test
