// Every fault of the emulator, at one of twenty cameras, through real packets into the frame
// history. Each stored frame's own pixels say which camera and trigger they are: a frame under
// another trigger's name is seen, whatever the counters say.
#include <cstdio>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "appliance/capture/camera_supervisor.h"
#include "appliance/capture/collector.h"
#include "appliance/capture/frame_history.h"
#include "appliance/capture/frame_reader.h"
#include "appliance/capture/trigger_loop.h"
#include "hal/aravis/aravis_camera.h"
#include "hal/aravis/camera_probe.h"
#include "hal/emulated/rig/stamp_code.h"
#include "hal/emulated/trigger_line.h"
#include "tests/support/child_process.h"
#include "tests/support/fault_port.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace std::chrono_literals;
using appliance::CollectorCounts;

constexpr std::uint32_t kCameras = 20;
constexpr std::uint32_t kFaulty = 6;  // from 0: people call it camera 7
constexpr std::uint32_t kWidth = 224;
constexpr std::uint32_t kHeight = 160;
constexpr rt::Nanoseconds kPeriod = 50ms;
constexpr std::uint32_t kSets = 128;
constexpr char kFirstAddress[] = "127.0.14.1";
constexpr std::uint16_t kWirePort = 3978;
constexpr std::uint16_t kFaultPort = 3991;
constexpr auto kPatience = 60s;

std::string addressOf(std::uint32_t camera) {
  return "127.0.14." + std::to_string(camera + 1);
}

hal::CameraProfile profileOf(std::uint32_t camera) {
  hal::CameraProfile profile;
  profile.name = "cam" + std::to_string(camera + 1);
  profile.address = addressOf(camera);
  profile.width_px = kWidth;
  profile.height_px = kHeight;
  profile.packet_size_bytes = 1500;
  return profile;
}

/// Emulated cameras, and the part of the appliance that receives them.
class Receiver {
 public:
  Receiver() {
    auto history = appliance::FrameHistory::create(
        {.frame_bytes = std::vector<std::size_t>(kCameras, std::size_t{kWidth} * kHeight),
         .sets = kSets,
         .in_flight = 16,
         .reserve = 4});
    auto line = hal::emulated::EmulatedTriggerLine::open(kWirePort);
    if (!history || !line) return;
    auto reader = (*history)->openReader("stamps", 1);
    if (!reader) return;
    reader_ = *reader;
    history_ = std::move(*history);
    line_ = std::move(*line);
    for (std::uint32_t i = 0; i < kCameras; ++i) {
      collectors_.push_back(std::make_unique<appliance::Collector>(
          i, appliance::Association{kPeriod, 1ms}, history_->camera(i), board_, nullptr));
      supervisors_.push_back(std::make_unique<appliance::CameraSupervisor>(
          appliance::CameraAccess{
              .probe =
                  [i](rt::Nanoseconds timeout) {
                    return hal::aravis::probeCamera(addressOf(i), timeout);
                  },
              .open = [i] { return hal::aravis::openCamera(profileOf(i), {.name = "recv"}); }},
          *collectors_[i], history_->camera(i), board_.edges));
    }
    trigger_ = std::make_unique<appliance::TriggerLoop>(
        appliance::TriggerTiming{.period = kPeriod, .pulse_width = 1ms}, *line_, board_.edges,
        board_.genlock, nullptr);
  }
  ~Receiver() {
    thread_ = {};
    for (auto& supervisor : supervisors_) supervisor->requestStop();
    for (auto& supervisor : supervisors_) supervisor->stop();
  }
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  /// Whether all cameras stream.
  bool start() {
    if (!trigger_) return false;
    for (std::uint32_t i = 0; i < kCameras; ++i) {
      if (!supervisors_[i]->start(i)) return false;
    }
    for (auto& supervisor : supervisors_) {
      if (!supervisor->waitSettled(rt::now() + kPatience)) return false;
    }
    thread_ = std::jthread([this](const std::stop_token& stop) { trigger_->run(stop); });
    return waitFor([this] {
      for (std::uint32_t i = 0; i < kCameras; ++i) {
        if (!isUpToDate(i)) return false;
      }
      return newest() > 20;
    });
  }

  [[nodiscard]] std::uint64_t newest() const { return board_.edges.newest(); }
  [[nodiscard]] CollectorCounts counts(std::uint32_t camera) const {
    return collectors_[camera]->counts();
  }
  /// Whether the last triggers' frames are stored, and all of them.
  [[nodiscard]] bool isUpToDate(std::uint32_t camera) const {
    const std::uint64_t last = history_->camera(camera).newest();
    if (last < 5 || last + 3 < newest()) return false;
    for (std::uint64_t trigger = last - 4; trigger <= last; ++trigger) {
      if (!history_->camera(camera).holds(trigger)) return false;
    }
    return true;
  }
  static bool waitFor(const std::function<bool()>& done) {
    const auto end = rt::now() + kPatience;
    while (!done()) {
      if (rt::now() > end) return false;
      std::this_thread::sleep_for(5ms);
    }
    return true;
  }
  void waitTriggers(std::uint64_t count) const {
    const std::uint64_t until = newest() + count;
    (void)waitFor([&] { return newest() >= until; });
  }

  /// The trigger of the first frame that @p camera stored since @p trigger, or 0.
  [[nodiscard]] std::uint64_t firstStoredAfter(std::uint32_t camera, std::uint64_t trigger) const {
    const auto& frames = history_->camera(camera);
    for (std::uint64_t t = trigger + 1; t <= frames.newest(); ++t) {
      if (frames.holds(t)) return t;
    }
    return 0;
  }

  /// Stored frames since @p trigger whose pixels say something else than their name.
  [[nodiscard]] unsigned wrongSince(std::uint64_t trigger, unsigned& looked_at) {
    unsigned wrong = 0;
    for (std::uint32_t camera = 0; camera < kCameras; ++camera) {
      for (std::uint64_t t = trigger; t <= newest(); ++t) {
        const auto pin = reader_->tryPin(camera, t);
        if (!pin) continue;
        ++looked_at;
        const auto* pixels = reinterpret_cast<const std::uint8_t*>(pin->pixels);
        const auto stamp = emulator::decodeStamp(
            emulator::StampLayout::of(kWidth, kHeight), [&](double x, double y) {
              return static_cast<double>(
                  pixels[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)]);
            });
        if (!stamp || stamp->camera != camera || stamp->trigger != t) ++wrong;
      }
    }
    return wrong;
  }

 private:
  std::unique_ptr<appliance::FrameHistory> history_;
  appliance::FrameReader* reader_ = nullptr;  // history_'s
  std::unique_ptr<hal::emulated::EmulatedTriggerLine> line_;
  appliance::CaptureBoard board_{kCameras};
  std::vector<std::unique_ptr<appliance::Collector>> collectors_;
  std::vector<std::unique_ptr<appliance::CameraSupervisor>> supervisors_;
  std::unique_ptr<appliance::TriggerLoop> trigger_;
  std::jthread thread_;
};

using Count = std::uint64_t CollectorCounts::*;

struct FaultCase {
  const char* name;
  std::vector<const char*> begin;
  std::uint64_t triggers;  // that it lasts
  std::vector<const char*> end;
  Count detected_by;  // which must grow, at the faulty camera; nullptr: it must cost nothing
  const char* how;
};

const std::vector<FaultCase>& allFaults() {
  constexpr auto kMissing = &CollectorCounts::missing;
  constexpr auto kAway = &CollectorCounts::away;
  static const std::vector<FaultCase> all = {
      {"ignores one trigger", {"ignore-triggers 1"}, 10, {}, kMissing, "gap of one trigger"},
      {"ignores every second", {"ignore-every 2"}, 20, {"clear"}, kMissing, "a gap each time"},
      {"sends one extra", {"extra-frame"}, 10, {}, &CollectorCounts::no_edge, "taken at no edge"},
      {"late leader, one period", {"late-leader 50"}, 10, {}, nullptr, "named by its clock"},
      {"wrong size", {"wrong-size on"}, 10, {"clear"}, &CollectorCounts::wrong_size, "size"},
      {"clock drifts 100 ppm", {"drift 100"}, 40, {"clear"}, nullptr, "followed"},
      {"ids about to wrap", {"frame-id 65530"}, 20, {}, &CollectorCounts::unsettled, "ids jump"},
      {"loses 5 % of packets", {"loss 5"}, 20, {"clear"}, nullptr, "asked for again"},
      {"reorders 20 %", {"reorder 20"}, 20, {"clear"}, nullptr, "put in order"},
      {"doubles 20 %", {"duplicate 20"}, 20, {"clear"}, nullptr, "taken once"},
      {"large packets vanish", {"mtu 1000"}, 10, {"clear"}, &CollectorCounts::incomplete, "holes"},
      {"freezes, thaws", {"freeze"}, 20, {"thaw"}, kAway, "no frames"},
      {"cable out, in again", {"kill"}, 40, {"revive"}, kAway, "no frames"},
      {"reboots to its defaults", {"reboot 1"}, 10, {}, kAway, "no frames"},
  };
  return all;
}

void command(const char* text) {
  const std::string line = std::to_string(kFaulty + 1) + " " + text;
  EXPECT_EQ(test::sendFault(kFirstAddress, kFaultPort, line), "ok") << line;
}

TEST(CameraFaults, AreDetectedNamedAndRepairedAndNeverShowAFrameForAnother) {
  const test::TemporaryFolder folder;
  test::ChildProcess emulator(
      {KAGAMI_EMULATOR, "--cameras", std::to_string(kCameras), "--size",
       std::to_string(kWidth) + "x" + std::to_string(kHeight), "--first-address", kFirstAddress,
       "--wire-port", std::to_string(kWirePort)},
      folder / "emulator.log");
  ASSERT_TRUE(emulator.waitForOutput("ready", 120s)) << emulator.output();
  Receiver receiver;
  ASSERT_TRUE(receiver.start()) << emulator.output();

  std::printf("%-25s %6s  %-20s %7s %9s %6s %7s %11s\n", "fault", "camera", "detected by", "count",
              "repaired", "wrong", "looked", "others lost");
  for (const FaultCase& fault : allFaults()) {
    SCOPED_TRACE(fault.name);
    ASSERT_TRUE(receiver.waitFor([&] { return receiver.isUpToDate(kFaulty); }));
    std::vector<CollectorCounts> before;
    for (std::uint32_t i = 0; i < kCameras; ++i) before.push_back(receiver.counts(i));
    const std::uint64_t began = receiver.newest();
    for (const char* text : fault.begin) command(text);
    receiver.waitTriggers(fault.triggers);
    for (const char* text : fault.end) command(text);
    const std::uint64_t ended = receiver.newest();
    const bool repaired = receiver.waitFor([&] { return receiver.isUpToDate(kFaulty); });
    receiver.waitTriggers(8);

    std::uint64_t others_lost = 0;
    for (std::uint32_t i = 0; i < kCameras; ++i) {
      if (i == kFaulty) continue;
      const CollectorCounts now = receiver.counts(i);
      others_lost += now.missing + now.away - before[i].missing - before[i].away;
    }
    unsigned looked_at = 0;
    const unsigned wrong = receiver.wrongSince(began, looked_at);
    const CollectorCounts after = receiver.counts(kFaulty);
    const std::uint64_t count = fault.detected_by == nullptr
                                    ? 0
                                    : after.*fault.detected_by - before[kFaulty].*fault.detected_by;
    const std::uint64_t first = receiver.firstStoredAfter(kFaulty, ended);
    std::printf("%-25s %6u  %-20s %7lu %6lu tr %6u %7u %11lu\n", fault.name, kFaulty + 1, fault.how,
                count, first - ended, wrong, looked_at, others_lost);
    std::fflush(stdout);
    EXPECT_TRUE(repaired);
    EXPECT_EQ(wrong, 0U);
    EXPECT_GT(looked_at, 0U);
    if (fault.detected_by != nullptr) {
      EXPECT_GT(count, 0U);
    }
  }
}

}  // namespace
