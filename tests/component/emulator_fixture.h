#pragma once

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <arv.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "hal/aravis/gobject.h"
#include "hal/emulated/rig/stamp_code.h"
#include "hal/emulated/trigger_line.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace test {

inline constexpr char kAddress[] = "127.0.1.1";
inline constexpr char kPort[] = "3997";
inline constexpr int kWidth = 640;
inline constexpr int kHeight = 480;

using CameraPointer = hal::aravis::Ref<ArvCamera>;
using StreamPointer = hal::aravis::Ref<ArvStream>;
using BufferPointer = hal::aravis::Ref<ArvBuffer>;

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

inline CameraPointer open(std::string& error) {
  Failure failure;
  CameraPointer camera(arv_camera_new(kAddress, &failure));
  error = failure.text();
  return camera;
}

/// What an appliance pushes; empty when every value stuck.
inline std::string pushProfile(ArvCamera* camera) {
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

inline std::optional<emulator::Stamp> readStamp(ArvBuffer* buffer) {
  std::size_t bytes = 0;
  const auto* pixels = static_cast<const std::uint8_t*>(arv_buffer_get_data(buffer, &bytes));
  if (bytes != std::size_t{kWidth} * kHeight) return std::nullopt;
  return emulator::decodeStamp(emulator::StampLayout::of(kWidth, kHeight), [&](double x, double y) {
    return static_cast<double>(
        pixels[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)]);
  });
}

/// The emulator's own program, real sockets, and Aravis at the other end.
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
    emulator_ = std::make_unique<ChildProcess>(command(more), folder_ / "output");
    ASSERT_TRUE(emulator_->waitForOutput("ready", std::chrono::seconds(60))) << emulator_->output();
    auto line = hal::emulated::EmulatedTriggerLine::open(3997);
    ASSERT_TRUE(line) << line.error();
    line_ = std::move(*line);
  }

  nlohmann::json stop() {
    emulator_->terminate();
    EXPECT_EQ(emulator_->wait(std::chrono::seconds(20)), 0) << emulator_->output();
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

  TemporaryFolder folder_;
  std::unique_ptr<ChildProcess> emulator_;
  std::unique_ptr<hal::emulated::EmulatedTriggerLine> line_;
};

}  // namespace test
