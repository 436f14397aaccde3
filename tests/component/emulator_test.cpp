// The emulator as its clients see it.
#include <cstdint>
#include <optional>
#include <string>
#include <thread>

#include <arv.h>
#include <gtest/gtest.h>

#include "hal/emulated/rig/features.h"
#include "tests/component/bare_client.h"
#include "tests/component/emulator_fixture.h"

namespace {

using namespace std::chrono_literals;
using test::BareClient;
using test::EmulatorTest;
using test::Failure;
using test::kAddress;
using test::kPort;
using test::open;
using test::pushProfile;

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

TEST_F(EmulatorTest, TellsAndDoesNotJudgeWhatHappenedInItsWarmUp) {
  for (const char* warm_up_s : {"0", "0.5"}) {
    start({"--warm-up-s", warm_up_s});
    std::string error;
    auto camera = open(error);
    ASSERT_TRUE(camera) << error;
    ASSERT_EQ(pushProfile(camera.get()), "");
    Failure f;
    arv_camera_set_float(camera.get(), "ExposureTime", 100'000, &f);
    auto stream = startStream(camera.get());
    ASSERT_TRUE(stream);
    pulse();
    pulse();  // the camera is still exposing
    std::this_thread::sleep_for(600ms);
    pulse();
    stream.reset();  // while there still is a camera that answers
    camera.reset();
    const auto stats = stop();
    const bool warmed_up = stats["warm_up"]["seconds"] > 0;
    EXPECT_EQ(stats["triggers"], 3) << warm_up_s;
    EXPECT_EQ(stats["overtriggers"], 1) << warm_up_s;
    EXPECT_EQ(stats["warm_up"]["overtriggers"], warmed_up ? 1 : 0) << warm_up_s;
    const auto reason = stats["invalid_reason"].get<std::string>();
    EXPECT_EQ(reason.find("1 trigger edges") == std::string::npos, warmed_up) << reason;
  }
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

TEST_F(EmulatorTest, FreesControlWhenTheControllerFallsSilent) {
  constexpr std::uint16_t kGranted = 0;
  constexpr std::uint16_t kDenied = 0x8006;
  constexpr std::uint32_t kControl = 2;
  start();
  BareClient first(kAddress);
  BareClient second(kAddress);
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
