// libkagami-depth.so.0: an OpenNI2 driver whose sensor is fed by another process through a ring in
// shared memory. To OpenNI2 and its users it is a sensor like any other: it can be plugged in and
// out, has its own clock, is late, and sees with noise and holes.

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

// The export macro below wants these two; the header that defines them is not installed.
#define XN_NEW(type, argument) new type(argument)
#define XN_DELETE(pointer) delete pointer
#include <Driver/OniDriverAPI.h>

#include "hal/emulated/openni/ring.h"
#include "hal/emulated/openni/sensor_clock.h"
#include "hal/emulated/openni/sensor_model.h"

namespace emulator {
namespace {

using namespace std::chrono_literals;

constexpr rt::Nanoseconds kLook = 10ms;  // how often the plug is looked at
constexpr int kFarthest_mm = 10000;

template <class Value>
OniStatus answer(void* data, int* size, const Value& value) {
  if (*size < static_cast<int>(sizeof value)) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(data, &value, sizeof value);
  *size = static_cast<int>(sizeof value);
  return ONI_STATUS_OK;
}

double ofEnvironment(const char* name, double otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atof(text);
}

class Stream final : public oni::driver::StreamBase {
 public:
  Stream(OniSensorType type, const RgbdFormat& format) : type_(type), format_(format) {
    mode_.pixelFormat =
        type == ONI_SENSOR_DEPTH ? ONI_PIXEL_FORMAT_DEPTH_1_MM : ONI_PIXEL_FORMAT_RGB888;
    mode_.resolutionX = static_cast<int>(format.width_px);
    mode_.resolutionY = static_cast<int>(format.height_px);
    mode_.fps = static_cast<int>(std::lround(format.rate_hz));
  }

  OniStatus start() override {
    running_.store(true, std::memory_order_release);
    return ONI_STATUS_OK;
  }
  /// After it nothing is delivered any more, nor is anything on its way.
  void stop() override {
    running_.store(false, std::memory_order_seq_cst);
    delivering_.wait(true, std::memory_order_seq_cst);
  }

  OniStatus getProperty(int id, void* data, int* size) override {
    const bool depth = type_ == ONI_SENSOR_DEPTH;
    const auto field_of_view = [this](std::uint32_t px) {
      return static_cast<float>(2 * std::atan(0.5 * px / format_.focal_px));
    };
    switch (id) {
      case ONI_STREAM_PROPERTY_VIDEO_MODE:
        return answer(data, size, mode_);
      case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
        return answer(data, size, field_of_view(format_.width_px));
      case ONI_STREAM_PROPERTY_VERTICAL_FOV:
        return answer(data, size, field_of_view(format_.height_px));
      case ONI_STREAM_PROPERTY_MIRRORING:
        return answer(data, size, OniBool{mirrored_.load()});
      case ONI_STREAM_PROPERTY_STRIDE:
        return answer(data, size, strideBytes());
      case ONI_STREAM_PROPERTY_CROPPING:
        return answer(data, size, OniCropping{});
      case ONI_STREAM_PROPERTY_MAX_VALUE:
        return depth ? answer(data, size, kFarthest_mm) : ONI_STATUS_NOT_SUPPORTED;
      case ONI_STREAM_PROPERTY_MIN_VALUE:
        return depth ? answer(data, size, 0) : ONI_STATUS_NOT_SUPPORTED;
      default:
        return ONI_STATUS_NOT_SUPPORTED;
    }
  }

  OniStatus setProperty(int id, const void* data, int size) override {
    if (id == ONI_STREAM_PROPERTY_VIDEO_MODE && size == sizeof mode_) {
      // There is one mode: asking for it is no error, as with other drivers.
      const auto& wanted = *static_cast<const OniVideoMode*>(data);
      const bool same = wanted.pixelFormat == mode_.pixelFormat &&
                        wanted.resolutionX == mode_.resolutionX &&
                        wanted.resolutionY == mode_.resolutionY && wanted.fps == mode_.fps;
      return same ? ONI_STATUS_OK : ONI_STATUS_BAD_PARAMETER;
    }
    if (id == ONI_STREAM_PROPERTY_MIRRORING && size == sizeof(OniBool)) {
      mirrored_.store(*static_cast<const OniBool*>(data));
      raisePropertyChanged(id, data, size);
      return ONI_STATUS_OK;
    }
    return ONI_STATUS_NOT_SUPPORTED;
  }

  OniBool isPropertySupported(int id) override {
    std::array<std::byte, 64> space{};
    int size = static_cast<int>(space.size());
    return getProperty(id, space.data(), &size) == ONI_STATUS_OK ? TRUE : FALSE;
  }

  /// A recorder learns from here what the pictures are; its file is unreadable without.
  void notifyAllProperties() override {
    for (const int id : {ONI_STREAM_PROPERTY_VIDEO_MODE, ONI_STREAM_PROPERTY_STRIDE,
                         ONI_STREAM_PROPERTY_CROPPING, ONI_STREAM_PROPERTY_HORIZONTAL_FOV,
                         ONI_STREAM_PROPERTY_VERTICAL_FOV, ONI_STREAM_PROPERTY_MIRRORING,
                         ONI_STREAM_PROPERTY_MAX_VALUE, ONI_STREAM_PROPERTY_MIN_VALUE}) {
      std::array<std::byte, 64> space{};
      int size = static_cast<int>(space.size());
      if (getProperty(id, space.data(), &size) == ONI_STATUS_OK)
        raisePropertyChanged(id, space.data(), size);
    }
  }

  /// Hands a picture out unless the stream is stopped. @p pixels: rows without padding.
  void deliver(std::span<const std::byte> pixels, std::uint64_t number, std::uint64_t stamp_us) {
    // One of both sees the other: stop() this, or this stop().
    delivering_.store(true, std::memory_order_seq_cst);
    if (running_.load(std::memory_order_seq_cst)) handOut(pixels, number, stamp_us);
    delivering_.store(false, std::memory_order_release);
    delivering_.notify_all();
  }

 private:
  void handOut(std::span<const std::byte> pixels, std::uint64_t number, std::uint64_t stamp_us) {
    OniFrame* frame = getServices().acquireFrame();
    if (frame == nullptr) return;  // the application holds them all: this picture is lost
    const std::size_t pixel_bytes = type_ == ONI_SENSOR_DEPTH ? 2 : 3;
    auto* to = static_cast<std::byte*>(frame->data);
    if (mirrored_.load() == FALSE) {
      std::memcpy(to, pixels.data(), pixels.size());
    } else {
      const std::size_t width = format_.width_px;
      for (std::size_t i = 0; i < format_.pixels(); ++i) {
        const std::size_t from = i / width * width + (width - 1 - i % width);
        std::memcpy(to + i * pixel_bytes, pixels.data() + from * pixel_bytes, pixel_bytes);
      }
    }
    frame->dataSize = static_cast<int>(pixels.size());
    frame->stride = strideBytes();
    frame->frameIndex = static_cast<int>(number);
    frame->videoMode = mode_;
    frame->width = mode_.resolutionX;
    frame->height = mode_.resolutionY;
    frame->cropOriginX = frame->cropOriginY = 0;
    frame->croppingEnabled = FALSE;
    frame->sensorType = type_;
    frame->timestamp = stamp_us;
    raiseNewFrame(frame);
    getServices().releaseFrame(frame);
  }

  [[nodiscard]] int strideBytes() const {
    return mode_.resolutionX * (type_ == ONI_SENSOR_DEPTH ? 2 : 3);
  }

  OniSensorType type_;
  RgbdFormat format_;
  OniVideoMode mode_{};
  std::atomic<bool> running_{false};
  std::atomic<bool> delivering_{false};
  std::atomic<OniBool> mirrored_{FALSE};
};

/// One plugged-in sensor while an application has it open.
class Device final : public oni::driver::DeviceBase {
 public:
  Device(DepthRingReader ring, const SensorClock& clock, const SensorTraits& traits)
      : ring_(std::move(ring)), clock_(clock), model_(traits, ring_.format()) {
    const RgbdFormat& format = ring_.format();
    const auto mode = [&format](OniPixelFormat pixels) {
      OniVideoMode of{};
      of.pixelFormat = pixels;
      of.resolutionX = static_cast<int>(format.width_px);
      of.resolutionY = static_cast<int>(format.height_px);
      of.fps = static_cast<int>(std::lround(format.rate_hz));
      return of;
    };
    modes_ = {mode(ONI_PIXEL_FORMAT_DEPTH_1_MM), mode(ONI_PIXEL_FORMAT_RGB888)};
    sensors_[0] = {ONI_SENSOR_DEPTH, 1, modes_.data()};
    sensors_[1] = {ONI_SENSOR_COLOR, 1, &modes_[1]};
    thread_ = std::jthread([this](const std::stop_token& stop) { play(stop); });
  }
  ~Device() override {
    thread_.request_stop();
    thread_.join();
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override {
    *sensors = sensors_.data();
    *count = ring_.format().colour ? 2 : 1;
    return ONI_STATUS_OK;
  }

  oni::driver::StreamBase* createStream(OniSensorType type) override {
    const std::scoped_lock lock(mutex_);
    auto& stream = type == ONI_SENSOR_DEPTH ? depth_ : colour_;
    const bool known =
        type == ONI_SENSOR_DEPTH || (type == ONI_SENSOR_COLOR && ring_.format().colour);
    if (!known || stream) return nullptr;
    stream = std::make_shared<Stream>(type, ring_.format());
    return stream.get();
  }
  void destroyStream(oni::driver::StreamBase* stream) override {
    static_cast<Stream*>(stream)->stop();
    const std::scoped_lock lock(mutex_);
    if (stream == depth_.get()) depth_.reset();
    if (stream == colour_.get()) colour_.reset();
  }

  OniStatus getProperty(int id, void* data, int* size) override {
    if (id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION)
      return answer(data, size, registration_.load());
    if (id == ONI_DEVICE_PROPERTY_SERIAL_NUMBER) {
      constexpr std::array<char, 8> kSerial = {'K', 'G', '0', '0', '0', '0', '1', '\0'};
      return answer(data, size, kSerial);
    }
    return ONI_STATUS_NOT_SUPPORTED;
  }
  OniStatus setProperty(int id, const void* data, int size) override {
    if (id != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION || size != sizeof(OniImageRegistrationMode))
      return ONI_STATUS_NOT_SUPPORTED;
    registration_.store(*static_cast<const OniImageRegistrationMode*>(data));
    return ONI_STATUS_OK;
  }
  OniBool isPropertySupported(int id) override {
    return id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION || id == ONI_DEVICE_PROPERTY_SERIAL_NUMBER
               ? TRUE
               : FALSE;
  }
  OniBool isImageRegistrationModeSupported(OniImageRegistrationMode mode) override {
    return mode == ONI_IMAGE_REGISTRATION_OFF || mode == ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR
               ? TRUE
               : FALSE;
  }

 private:
  void play(const std::stop_token& stop) {
    const std::size_t pixels = ring_.format().pixels();
    std::vector<float> depth_m(pixels);
    std::vector<std::uint8_t> perfect(ring_.format().colour ? 3 * pixels : 0);
    std::vector<std::uint16_t> depth_mm(pixels);
    std::vector<std::uint16_t> raw_mm(pixels);
    std::vector<std::uint8_t> rgb(perfect.size());
    std::uint64_t last = ring_.newest();
    while (!stop.stop_requested()) {
      ring_.waitAfter(last, 20ms);
      const std::uint64_t newest = ring_.newest();
      if (newest <= last) continue;
      auto stamp = ring_.stamp(last + 1);
      if (!stamp) {  // overwritten: we were away too long
        last = newest - 1;
        continue;
      }
      last = stamp->number;
      if (!ring_.read(last, depth_m, perfect)) continue;
      model_.senseDepth(depth_m, perfect, last, depth_mm);
      if (registration_.load() == ONI_IMAGE_REGISTRATION_OFF) {
        model_.unregister(depth_mm, raw_mm);
        depth_mm.swap(raw_mm);
      }
      if (!rgb.empty()) model_.senseColour(perfect, last, rgb);
      std::this_thread::sleep_until(clock_.arrival(stamp->exposure, last));
      deliver(*stamp, depth_mm, rgb);
    }
  }

  void deliver(const DepthRingReader::Stamp& stamp, std::span<const std::uint16_t> depth_mm,
               std::span<const std::uint8_t> rgb) {
    if (!ring_.plugged()) return;
    // OpenNI2 takes locks of its own while it gets a picture, and holds them while it makes and
    // destroys streams: ours is not held meanwhile.
    const auto [depth, colour] = [this] {
      const std::scoped_lock lock(mutex_);
      return std::pair(depth_, colour_);
    }();
    const std::uint64_t stamp_us = clock_.stamp_us(stamp.exposure);
    if (depth) depth->deliver(std::as_bytes(depth_mm), stamp.number, stamp_us);
    if (colour) colour->deliver(std::as_bytes(rgb), stamp.number, stamp_us);
  }

  DepthRingReader ring_;
  SensorClock clock_;
  SensorModel model_;
  std::array<OniVideoMode, 2> modes_{};
  std::array<OniSensorInfo, 2> sensors_{};
  std::atomic<OniImageRegistrationMode> registration_{ONI_IMAGE_REGISTRATION_OFF};
  std::mutex mutex_;               // the streams' lives
  std::shared_ptr<Stream> depth_;  // the last owner may be play(), which delivers no more
  std::shared_ptr<Stream> colour_;
  std::jthread thread_;  // ends before what it uses
};

class Driver final : public oni::driver::DriverBase {
 public:
  explicit Driver(OniDriverServices* services) : DriverBase(services) {
    std::strncpy(info_.uri, ("kagami-depth:" + path_).c_str(), sizeof info_.uri - 1);
    std::strncpy(info_.vendor, "Kagami", sizeof info_.vendor - 1);
    std::strncpy(info_.name, "Emulated RGB-D", sizeof info_.name - 1);
    clock_.drift_ppm = ofEnvironment("KAGAMI_DEPTH_DRIFT_PPM", clock_.drift_ppm);
    traits_.seed = static_cast<std::uint64_t>(ofEnvironment("KAGAMI_DEPTH_SEED", 1));
  }

  OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                       oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback changed, void* cookie) override {
    DriverBase::initialize(connected, disconnected, changed, cookie);
    look();
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        std::this_thread::sleep_for(kLook);
        look();
      }
    });
    return ONI_STATUS_OK;
  }

  void shutdown() override {
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
  }

  oni::driver::DeviceBase* deviceOpen(const char* uri, const char* /*mode*/) override {
    if (std::strcmp(uri, info_.uri) != 0) return nullptr;
    auto ring = DepthRingReader::open(path_);
    if (!ring || !ring->plugged()) return nullptr;
    const std::scoped_lock lock(mutex_);
    return new Device(std::move(*ring), clock_, traits_);
  }
  void deviceClose(oni::driver::DeviceBase* device) override { delete device; }

 private:
  /// Reports to OpenNI2 when the sensor comes and goes.
  void look() {
    if (!ring_) {
      if (auto opened = DepthRingReader::open(path_)) ring_ = std::move(*opened);
    }
    const bool plugged = ring_ && ring_->plugged();
    if (!plugged) ring_.reset();  // the next one may be another file
    if (plugged == plugged_) return;
    plugged_ = plugged;
    if (plugged) {
      {
        const std::scoped_lock lock(mutex_);
        clock_.power_on = rt::now();
      }
      deviceConnected(&info_);
    } else {
      deviceStateChanged(&info_, ONI_DEVICE_STATE_ERROR);
      deviceDisconnected(&info_);
    }
  }

  const std::string path_ = depthRingPath();
  OniDeviceInfo info_{};
  SensorTraits traits_;
  std::mutex mutex_;  // the clock
  SensorClock clock_;
  std::optional<DepthRingReader> ring_;
  bool plugged_ = false;
  std::jthread thread_;
};

}  // namespace
}  // namespace emulator

ONI_EXPORT_DRIVER(emulator::Driver)
