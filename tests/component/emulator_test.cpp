// The emulator as its clients see it: its own program, real sockets, Aravis at the other end.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <arv.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/socket.h>

#include "hal/emulated/rig/bytes.h"
#include "hal/emulated/rig/features.h"
#include "hal/emulated/rig/gvcp.h"
#include "hal/emulated/rig/socket.h"
#include "hal/emulated/rig/stamp_code.h"
#include "hal/emulated/trigger_line.h"
#include "tests/support/child_process.h"
#include "tests/support/fault_port.h"

namespace {

using namespace std::chrono_literals;

constexpr char kAddress[] = "127.0.1.1";
constexpr char kPort[] = "3997";
constexpr int kWidth = 640;
constexpr int kHeight = 480;

struct Unref {
  void operator()(gpointer object) const { g_object_unref(object); }
};
using CameraPointer = std::unique_ptr<ArvCamera, Unref>;
using StreamPointer = std::unique_ptr<ArvStream, Unref>;
using BufferPointer = std::unique_ptr<ArvBuffer, Unref>;

/// Collects the first thing that went wrong in a row of Aravis calls.
class Failure {
 public:
  Failure() = default;
  ~Failure() { g_clear_error(&error_); }
  Failure(const Failure&) = delete;
  Failure& operator=(const Failure&) = delete;
  GError** operator&() {  // NOLINT(google-runtime-operator)
    if (error_ != nullptr && text_.empty()) text_ = error_->message;
    g_clear_error(&error_);
    return &error_;
  }
  [[nodiscard]] std::string text() const {
    return !text_.empty() ? text_ : error_ != nullptr ? error_->message : "";
  }

 private:
  GError* error_ = nullptr;
  std::string text_;
};

CameraPointer open(std::string& error) {
  Failure failure;
  CameraPointer camera(arv_camera_new(kAddress, &failure));
  error = failure.text();
  return camera;
}

/// What an appliance pushes; empty when every value stuck.
std::string pushProfile(ArvCamera* camera) {
  Failure f;
  arv_camera_set_pixel_format(camera, ARV_PIXEL_FORMAT_BAYER_RG_8, &f);
  arv_camera_set_string(camera, "ExposureAuto", "Off", &f);
  arv_camera_set_string(camera, "GainAuto", "Off", &f);
  arv_camera_set_string(camera, "BalanceWhiteAuto", "Off", &f);
  arv_camera_set_float(camera, "ExposureTime", 1000, &f);
  arv_camera_set_float(camera, "Gain", 0, &f);
  for (const char* colour : {"Red", "Green", "Blue"}) {
    arv_camera_set_string(camera, "BalanceRatioSelector", colour, &f);
    arv_camera_set_float(camera, "BalanceRatio", 1, &f);
  }
  arv_camera_set_trigger(camera, "Line1", &f);
  arv_camera_gv_set_packet_size(camera, 9000, &f);
  arv_camera_gv_set_packet_size_adjustment(camera, ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
  arv_camera_gv_set_stream_options(camera, ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
  return f.text();
}

std::optional<emulator::Stamp> readStamp(ArvBuffer* buffer) {
  std::size_t bytes = 0;
  const auto* pixels = static_cast<const std::uint8_t*>(arv_buffer_get_data(buffer, &bytes));
  if (bytes != std::size_t{kWidth} * kHeight) return std::nullopt;
  return emulator::decodeStamp(emulator::StampLayout::of(kWidth, kHeight), [&](double x, double y) {
    return static_cast<double>(
        pixels[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)]);
  });
}

class EmulatorTest : public testing::Test {
 protected:
  std::vector<std::string> command(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {KAGAMI_EMULATOR,
                                      "--cameras",
                                      "1",
                                      "--size",
                                      "640x480",
                                      "--first-address",
                                      kAddress,
                                      "--wire-port",
                                      kPort,
                                      "--stats",
                                      folder_ / "stats.json",
                                      "--wire-log",
                                      folder_ / "wire.csv"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  void start(const std::vector<std::string>& more = {}) {
    emulator_ = std::make_unique<test::ChildProcess>(command(more), folder_ / "output");
    ASSERT_TRUE(emulator_->waitForOutput("ready", 60s)) << emulator_->output();
    auto line = hal::emulated::EmulatedTriggerLine::open(3997);
    ASSERT_TRUE(line) << line.error();
    line_ = std::move(*line);
  }

  nlohmann::json stop() {
    emulator_->terminate();
    EXPECT_EQ(emulator_->wait(20s), 0) << emulator_->output();
    std::ifstream file(folder_ / "stats.json");
    return nlohmann::json::parse(file, nullptr, false);
  }

  void pulse() {
    EXPECT_TRUE(line_->setActive(true));
    EXPECT_TRUE(line_->setActive(false));
  }

  std::size_t wireLogLines() {
    std::ifstream file(folder_ / "wire.csv");
    return static_cast<std::size_t>(
        std::count(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>(), '\n'));
  }

  /// Opens a stream with a few buffers and starts the camera.
  StreamPointer startStream(ArvCamera* camera) {
    Failure f;
    StreamPointer stream(arv_camera_create_stream(camera, nullptr, nullptr, &f));
    EXPECT_TRUE(stream) << f.text();
    if (!stream) return stream;
    g_object_set(stream.get(), "packet-timeout", 5000u, "frame-retention", 1'000'000u,
                 "packet-request-ratio", 1.0, nullptr);
    for (int i = 0; i < 8; ++i) {
      arv_stream_push_buffer(stream.get(), arv_buffer_new(std::size_t{kWidth} * kHeight, nullptr));
    }
    arv_camera_start_acquisition(camera, &f);
    EXPECT_EQ(f.text(), "");
    return stream;
  }

  /// Fires one pulse after the other and expects each one's picture.
  void expectPicturePerPulse(ArvStream* stream, std::uint32_t pulses) {
    for (std::uint32_t trigger = 1; trigger <= pulses; ++trigger) {
      pulse();
      const BufferPointer buffer(arv_stream_timeout_pop_buffer(stream, 10'000'000));
      ASSERT_TRUE(buffer) << "no frame for trigger " << trigger;
      ASSERT_EQ(arv_buffer_get_status(buffer.get()), ARV_BUFFER_STATUS_SUCCESS) << trigger;
      const auto stamp = readStamp(buffer.get());
      ASSERT_TRUE(stamp) << trigger;
      EXPECT_EQ(stamp->camera, 0);
      EXPECT_EQ(stamp->trigger, trigger);
      arv_stream_push_buffer(stream, static_cast<ArvBuffer*>(g_object_ref(buffer.get())));
    }
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<test::ChildProcess> emulator_;
  std::unique_ptr<hal::emulated::EmulatedTriggerLine> line_;
};

TEST_F(EmulatorTest, GivesOneStampedFramePerPulse) {
  start();
  std::string error;
  auto camera = open(error);
  ASSERT_TRUE(camera) << error;
  ASSERT_EQ(pushProfile(camera.get()), "");
  auto stream = startStream(camera.get());
  ASSERT_TRUE(stream);
  expectPicturePerPulse(stream.get(), 20);
  stream.reset();  // while there still is a camera that answers
  camera.reset();
  const auto stats = stop();
  EXPECT_EQ(stats["triggers"], 20);
  EXPECT_EQ(stats["frames_sent"], 20);
  EXPECT_EQ(stats["overtriggers"], 0);
  EXPECT_EQ(wireLogLines(), 21u);
}

TEST_F(EmulatorTest, SendsAgainWhatTheWireLost) {
  start({"--loss", "0.02", "--seed", "7"});
  std::string error;
  auto camera = open(error);
  ASSERT_TRUE(camera) << error;
  ASSERT_EQ(pushProfile(camera.get()), "");
  Failure f;
  arv_camera_gv_set_packet_size(camera.get(), 1500, &f);  // more packets, more losses
  auto stream = startStream(camera.get());
  ASSERT_TRUE(stream);
  expectPicturePerPulse(stream.get(), 30);
  stream.reset();  // while there still is a camera that answers
  camera.reset();
  const auto stats = stop();
  EXPECT_GT(stats["packets_lost_on_purpose"], 0);
  EXPECT_GT(stats["packets_resent"], 0);
}

TEST_F(EmulatorTest, KeepsEverySettingThatItAccepted) {
  start();
  std::string error;
  const auto camera = open(error);
  ASSERT_TRUE(camera) << error;
  Failure before;
  EXPECT_STREQ(arv_camera_get_string(camera.get(), "PixelFormat", &before), "Mono8");
  EXPECT_STREQ(arv_camera_get_string(camera.get(), "TriggerMode", &before), "Off");
  EXPECT_STREQ(arv_camera_get_string(camera.get(), "ExposureAuto", &before), "Continuous");
  arv_camera_set_float(camera.get(), "ExposureTime", 1000, &before);
  EXPECT_NE(before.text(), "") << "a manual exposure while the automatic one runs";

  ASSERT_EQ(pushProfile(camera.get()), "");
  Failure f;
  arv_camera_gv_set_packet_delay(camera.get(), 80'000, &f);
  arv_camera_set_region(camera.get(), 8, 4, 320, 240, &f);
  EXPECT_EQ(f.text(), "");
  EXPECT_STREQ(arv_camera_get_string(camera.get(), "PixelFormat", &f), "BayerRG8");
  EXPECT_STREQ(arv_camera_get_string(camera.get(), "TriggerMode", &f), "On");
  EXPECT_STREQ(arv_camera_get_string(camera.get(), "TriggerSource", &f), "Line1");
  EXPECT_DOUBLE_EQ(arv_camera_get_float(camera.get(), "ExposureTime", &f), 1000);
  EXPECT_DOUBLE_EQ(arv_camera_get_float(camera.get(), "Gain", &f), 0);
  EXPECT_DOUBLE_EQ(arv_camera_get_float(camera.get(), "BalanceRatio", &f), 1);
  EXPECT_EQ(arv_camera_get_integer(camera.get(), "GevSCPSPacketSize", &f), 9000);
  EXPECT_EQ(arv_camera_get_integer(camera.get(), "GevSCPD", &f), 80'000);
  EXPECT_EQ(arv_camera_get_payload(camera.get(), &f), 320u * 240u);
  EXPECT_STREQ(arv_camera_get_string(camera.get(), "DeviceUserID", &f), "cam01");
  EXPECT_EQ(f.text(), "");
  arv_camera_set_region(camera.get(), 400, 0, 320, 240, &f);
  EXPECT_NE(f.text(), "") << "a region that leaves the sensor";
}

TEST_F(EmulatorTest, ObeysOneControllerAtATime) {
  start();
  std::string error;
  const auto first = open(error);
  ASSERT_TRUE(first) << error;
  const auto second = open(error);  // Aravis opens it all the same, to look but not to touch
  if (second) {
    Failure f;
    arv_camera_set_string(second.get(), "TriggerMode", "On", &f);
    EXPECT_NE(f.text(), "");
  }
  Failure f;
  arv_camera_set_string(first.get(), "TriggerMode", "On", &f);
  EXPECT_EQ(f.text(), "");
}

/// A client that speaks GVCP by hand, to fall silent as Aravis never does.
class BareClient {
 public:
  BareClient() : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(emulator::gvcp::kPort);
    ::inet_pton(AF_INET, kAddress, &to.sin_addr);
    (void)::connect(fd_.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }
  /// The status of a register write; nothing without an answer.
  std::optional<std::uint16_t> write(std::uint32_t address, std::uint32_t value) {
    std::array<std::uint8_t, 16> bytes = {0x42, 1, 0, 0x82, 0, 8, 0, 1};
    emulator::storeBe32(&bytes[8], address);
    emulator::storeBe32(&bytes[12], value);
    (void)::send(fd_.get(), bytes.data(), bytes.size(), 0);
    pollfd ready{fd_.get(), POLLIN, 0};
    if (::poll(&ready, 1, 5000) != 1 || ::recv(fd_.get(), bytes.data(), bytes.size(), 0) < 8) {
      return std::nullopt;
    }
    return emulator::loadBe16(bytes.data());
  }

 private:
  emulator::UniqueFd fd_;
};

TEST_F(EmulatorTest, FreesControlWhenTheControllerFallsSilent) {
  constexpr std::uint16_t kGranted = 0;
  constexpr std::uint16_t kDenied = 0x8006;
  constexpr std::uint32_t kControl = 2;
  start();
  BareClient first;
  BareClient second;
  ASSERT_EQ(first.write(emulator::reg::kControlPrivilege, kControl), kGranted);
  ASSERT_EQ(second.write(emulator::reg::kControlPrivilege, kControl), kDenied);
  ASSERT_EQ(first.write(emulator::reg::kHeartbeatTimeout, 500), kGranted);
  std::optional<std::uint16_t> status;
  for (int i = 0; i < 200 && status != kGranted; ++i) {
    std::this_thread::sleep_for(50ms);
    status = second.write(emulator::reg::kControlPrivilege, kControl);
  }
  EXPECT_EQ(status, kGranted);
  EXPECT_EQ(first.write(emulator::reg::kHeartbeatTimeout, 500), kDenied);
}

/// Faults on command at a camera that streams; what comes of them is seen from outside.
class EmulatorFaultTest : public EmulatorTest {
 protected:
  void SetUp() override {
    start({"--fault-log", folder_ / "faults.csv"});
    std::string error;
    camera_ = open(error);
    ASSERT_TRUE(camera_) << error;
    ASSERT_EQ(pushProfile(camera_.get()), "");
    stream_ = startStream(camera_.get());
    ASSERT_TRUE(stream_);
  }
  void TearDown() override {
    stream_.reset();
    camera_.reset();
  }
  static void fault(const std::string& text) {
    EXPECT_EQ(test::sendFault(kAddress, 3991, "1 " + text), "ok") << text;
  }
  /// The next frame, whole; null when none comes.
  BufferPointer frame(std::chrono::microseconds patience = 10s) {
    BufferPointer buffer(
        arv_stream_timeout_pop_buffer(stream_.get(), static_cast<guint64>(patience.count())));
    if (buffer) {
      arv_stream_push_buffer(stream_.get(), ARV_BUFFER(g_object_ref(buffer.get())));
    }
    return buffer;
  }
  void expectFrameOf(std::uint32_t trigger) {
    const BufferPointer buffer = frame();
    ASSERT_TRUE(buffer) << trigger;
    const auto stamp = readStamp(buffer.get());
    ASSERT_TRUE(stamp) << trigger;
    EXPECT_EQ(stamp->trigger, trigger);
  }
  std::string faultLog() {
    std::ifstream file(folder_ / "faults.csv");
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  CameraPointer camera_;
  StreamPointer stream_;
};

TEST_F(EmulatorFaultTest, PassesOverEdgesWithoutUsingUpIds) {
  pulse();
  const BufferPointer first = frame();
  ASSERT_TRUE(first);
  const guint64 id = arv_buffer_get_frame_id(first.get());
  fault("ignore-triggers 2");
  for (int i = 0; i < 2; ++i) pulse();
  EXPECT_FALSE(frame(300ms));
  pulse();
  const BufferPointer next = frame();
  ASSERT_TRUE(next);
  EXPECT_EQ(arv_buffer_get_frame_id(next.get()), id + 1);
  EXPECT_EQ(readStamp(next.get())->trigger, 4U);
  TearDown();
  const auto stats = stop();
  EXPECT_EQ(stats["overtriggers"], 0);
  EXPECT_EQ(stats["frames_withheld_on_purpose"], 2);
  EXPECT_NE(faultLog().find(",1,ignore-triggers 2\n"), std::string::npos) << faultLog();
  EXPECT_NE(faultLog().find(",1,effect ignore-triggers trigger 3\n"), std::string::npos);
}

TEST_F(EmulatorFaultTest, SendsAFrameThatNothingAskedFor) {
  fault("extra-frame");
  expectFrameOf(0);
  pulse();
  expectFrameOf(1);
}

TEST_F(EmulatorFaultTest, WrapsItsIdsWhereTold) {
  fault("frame-id 65535");
  pulse();
  const BufferPointer last = frame();
  ASSERT_TRUE(last);
  EXPECT_EQ(arv_buffer_get_frame_id(last.get()), 65'535U);
  pulse();
  const BufferPointer next = frame();
  ASSERT_TRUE(next);
  EXPECT_EQ(arv_buffer_get_frame_id(next.get()), 1U);
}

TEST_F(EmulatorFaultTest, SendsHalfAFrameAndThenWholeOnesAgain) {
  fault("wrong-size on");
  pulse();
  const BufferPointer half = frame();
  ASSERT_TRUE(half);
  EXPECT_EQ(arv_buffer_get_image_height(half.get()), kHeight / 2);
  fault("clear");
  pulse();
  expectFrameOf(2);
}

TEST_F(EmulatorFaultTest, HoldsAFrameBackAndTheNextBehindIt) {
  fault("late-leader 2000");
  pulse();
  EXPECT_FALSE(frame(100ms));
  pulse();
  expectFrameOf(1);
  expectFrameOf(2);
}

TEST_F(EmulatorFaultTest, FrozenAnswersButSendsNothing) {
  fault("freeze");
  pulse();
  EXPECT_FALSE(frame(300ms));
  Failure f;
  EXPECT_STREQ(arv_camera_get_string(camera_.get(), "TriggerMode", &f), "On");
  fault("thaw");
  pulse();
  expectFrameOf(2);
}

TEST_F(EmulatorFaultTest, UnpluggedKeepsItsSettingsAndItsController) {
  fault("kill");
  pulse();
  EXPECT_FALSE(frame(300ms));
  fault("revive");
  pulse();
  expectFrameOf(2);
  TearDown();
  EXPECT_EQ(stop()["frames_sent"], 1);
  EXPECT_EQ(wireLogLines(), 2U) << "a frame of which no packet left is not in the wire log";
  EXPECT_NE(faultLog().find("effect kill trigger 1 frame 1 packets "), std::string::npos)
      << faultLog();
}

TEST_F(EmulatorFaultTest, WakesUpFromARebootWithItsDefaultsAndWithoutAController) {
  fault("reboot 0.2");
  BareClient client;
  std::optional<std::uint16_t> status;
  for (int i = 0; i < 100 && !status; ++i) {
    status = client.write(emulator::reg::kControlPrivilege, 2);
  }
  EXPECT_EQ(status, 0);
  EXPECT_EQ(client.write(emulator::reg::kExposureTime, 0x447a0000), 0x8004)
      << "automatic, as switched on";
}

TEST_F(EmulatorFaultTest, TellsASlowerLink) {
  Failure f;
  EXPECT_EQ(arv_camera_get_integer(camera_.get(), "GevLinkSpeed", &f), 1000);
  fault("link 100");
  EXPECT_EQ(arv_camera_get_integer(camera_.get(), "GevLinkSpeed", &f), 100);
  EXPECT_EQ(f.text(), "");
}

TEST_F(EmulatorFaultTest, DeliversThroughAWireThatReordersAndDoublesPackets) {
  fault("reorder 30");
  fault("duplicate 30");
  expectPicturePerPulse(stream_.get(), 10);
  TearDown();
  const auto stats = stop();
  EXPECT_GT(stats["packets_overtaken"], 0);
  EXPECT_GT(stats["packets_doubled"], 0);
}

TEST_F(EmulatorFaultTest, LosesLargeDatagramsOnAPathThatDoesNotCarryThem) {
  fault("mtu 1500");
  pulse();
  BufferPointer buffer = frame(1s);
  if (!buffer) {
    pulse();  // newer Aravis waits for the payload of a leader until a later frame begins
    buffer = frame();
  }
  ASSERT_TRUE(buffer);
  EXPECT_NE(arv_buffer_get_status(buffer.get()), ARV_BUFFER_STATUS_SUCCESS);
  TearDown();
  (void)stop();
  EXPECT_NE(faultLog().find("effect mtu trigger 1 frame 1 packets "), std::string::npos)
      << faultLog();
}

TEST_F(EmulatorTest, SaysWhichAddressAndPortAreInUse) {
  start();
  test::ChildProcess second(command(), folder_ / "second");
  EXPECT_EQ(second.wait(60s), 1);
  EXPECT_NE(second.output().find("127.0.0.1 UDP port 3997 is in use"), std::string::npos)
      << second.output();
  auto words = command();
  *std::ranges::find(words, kPort) = "3998";
  test::ChildProcess third(words, folder_ / "third");
  EXPECT_EQ(third.wait(60s), 1);
  EXPECT_NE(third.output().find("127.0.1.1 UDP port 3956 is in use"), std::string::npos)
      << third.output();
}

TEST_F(EmulatorTest, RefusesScenesAndSizesThatMakeNoSense) {
  const std::vector<std::vector<std::string>> cases = {
      {"--scene", "/nonexistent"}, {"--size", "abc"},       {"--size", "100x100"},
      {"--first-address", "home"}, {"--link-gbps", "fast"}, {"--wire-log", "/nonexistent/x"}};
  for (const auto& words : cases) {
    std::vector<std::string> all = {
        KAGAMI_EMULATOR, "--wire-port", kPort, "--cameras", "1", "--seconds", "1"};
    if (words[0] != "--first-address") {
      all.insert(all.end(), {"--first-address", kAddress});
    }
    if (words[0] != "--size") all.insert(all.end(), {"--size", "640x480"});
    all.insert(all.end(), words.begin(), words.end());
    test::ChildProcess process(all, folder_ / "refused");
    const auto status = process.wait(60s);
    ASSERT_TRUE(status);
    EXPECT_NE(*status, 0) << words[0] << ' ' << words[1];
    EXPECT_NE(process.output(), "");
    EXPECT_EQ(process.output().find("ready"), std::string::npos);
  }
}

}  // namespace
