#include "hal/openni/device.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <deque>
#include <utility>

#include <OpenNI.h>

#include "hal/openni/oni_header.h"
#include "hal/openni/pair_maker.h"
#include "rt/printable.h"

namespace hal::openni {
namespace {

namespace ni = ::openni;
using namespace std::chrono_literals;

// A recording's reader answers immediately. If it has not after this, the recording has ended.
constexpr rt::Nanoseconds kEndOfFile = 500ms;

/// What OpenNI2 says of its last failure, on one line.
std::string reason() {
  std::string text = ni::OpenNI::getExtendedError();
  std::ranges::replace_if(text, [](char c) { return c == '\n' || c == '\t' || c == '\r'; }, ' ');
  const std::size_t begin = text.find_first_not_of(' ');
  const std::size_t end = text.find_last_not_of(' ');
  if (begin == std::string::npos) return "OpenNI2 gives no reason";
  return rt::printable(text.substr(begin, end - begin + 1));
}

std::string sizeOf(const VideoMode& mode) {
  return std::to_string(mode.width_px) + "x" + std::to_string(mode.height_px) + " at " +
         std::to_string(mode.rate_hz) + " Hz";
}

VideoMode modeOf(const ni::VideoMode& mode) {
  return {static_cast<std::uint32_t>(std::max(0, mode.getResolutionX())),
          static_cast<std::uint32_t>(std::max(0, mode.getResolutionY())),
          static_cast<std::uint32_t>(std::max(0, mode.getFps()))};
}

bool isFile(const std::string& source) {
  return source.ends_with(".oni");
}

/// Notes that the device went; OpenNI2 calls it on a thread of its own.
class GoneListener final : public ni::OpenNI::DeviceDisconnectedListener {
 public:
  explicit GoneListener(std::string uri) : uri_(std::move(uri)) {}
  void onDeviceDisconnected(const ni::DeviceInfo* info) override {
    if (uri_ == info->getUri()) gone_.store(true, std::memory_order_release);
  }
  [[nodiscard]] bool gone() const { return gone_.load(std::memory_order_acquire); }

 private:
  const std::string uri_;
  std::atomic<bool> gone_{false};
};

/// OpenNI2 reports fields of view and assumes that the optical axis is in the middle.
DepthLens lensOf(const ni::VideoStream& stream) {
  const auto focal_px = [](std::uint32_t size, float field_of_view) {
    return 0.5 * size / std::tan(0.5 * static_cast<double>(field_of_view));
  };
  const VideoMode mode = modeOf(stream.getVideoMode());
  return {.focal_x_px = focal_px(mode.width_px, stream.getHorizontalFieldOfView()),
          .focal_y_px = focal_px(mode.height_px, stream.getVerticalFieldOfView()),
          .centre_x_px = 0.5 * (mode.width_px - 1.0),
          .centre_y_px = 0.5 * (mode.height_px - 1.0)};
}

/// The modes of one sensor that have our pixel format, and the streams' own objects for them.
struct Modes {
  std::vector<VideoMode> ours;
  std::vector<ni::VideoMode> theirs;
};
Modes modesOf(const ni::SensorInfo& sensor, ni::PixelFormat format) {
  Modes modes;
  const ni::Array<ni::VideoMode>& all = sensor.getSupportedVideoModes();
  for (int i = 0; i < all.getSize(); ++i) {
    if (all[i].getPixelFormat() != format) continue;
    modes.ours.push_back(modeOf(all[i]));
    modes.theirs.push_back(all[i]);
  }
  return modes;
}

}  // namespace

struct Device::Implementation {
  Facts facts;
  ni::Device device;
  ni::VideoStream depth;
  ni::VideoStream colour;
  std::unique_ptr<GoneListener> gone;
  ni::Recorder recorder;

  struct Picture {
    ni::VideoFrameRef frame;
    rt::Timestamp at;
  };
  struct Ready {
    Picture depth;
    std::optional<Picture> colour;
  };
  std::optional<PairMaker<Picture>> pairs;
  std::deque<Ready> ready;
  Ready lent;
  std::vector<std::uint16_t> depth_rows;  // where the driver pads its rows
  std::vector<std::uint8_t> colour_rows;

  std::expected<void, std::string> openDepth(const DeviceRequest& request);
  void openColour(const DeviceRequest& request);
  void settle();
  void lend(DevicePair& pair);

  ~Implementation() {
    if (recorder.isValid()) {
      recorder.stop();
      recorder.destroy();
    }
    if (gone) ni::OpenNI::removeDeviceDisconnectedListener(gone.get());
    for (ni::VideoStream* stream : {&depth, &colour}) {
      if (!stream->isValid()) continue;
      stream->stop();
      stream->destroy();
    }
    device.close();
  }
};

Device::Device(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Device::~Device() = default;

const Device::Facts& Device::facts() const {
  return implementation_->facts;
}

std::expected<void, std::string> Device::startLibrary() {
  if (ni::OpenNI::initialize() == ni::STATUS_OK) return {};
  return std::unexpected("OpenNI2 does not start: " + reason() +
                         ": check depth_sensor.drivers and the packages of its drivers");
}

bool Device::present(const std::string& source) {
  if (isFile(source)) return true;
  ni::Array<ni::DeviceInfo> devices;
  ni::OpenNI::enumerateDevices(&devices);
  for (int i = 0; i < devices.getSize(); ++i) {
    if (source.empty() || source == devices[i].getUri()) return true;
  }
  return false;
}

std::vector<std::string> Device::list() {
  ni::Array<ni::DeviceInfo> devices;
  ni::OpenNI::enumerateDevices(&devices);
  std::vector<std::string> lines;
  for (int i = 0; i < devices.getSize(); ++i) {
    const ni::DeviceInfo& info = devices[i];
    lines.push_back(
        rt::printable(std::string(info.getUri()) + "  " + info.getVendor() + " " + info.getName()));
  }
  return lines;
}

std::expected<std::unique_ptr<Device>, std::string> Device::open(const DeviceRequest& request) {
  auto made = std::make_unique<Implementation>();
  const char* uri = request.source.empty() ? ni::ANY_DEVICE : request.source.c_str();
  const std::string who = "depth sensor" + (request.source.empty() ? "" : " " + request.source);
  if (made->device.open(uri) != ni::STATUS_OK) {
    if (isFile(request.source)) {
      return std::unexpected(who + ": cannot be played (" + reason() +
                             "): is it there, and was it copied whole?");
    }
    return std::unexpected(who + ": does not open (" + reason() +
                           "): is another program using it, are the udev rules of its vendor "
                           "installed?");
  }
  made->facts.recording = made->device.isFile();
  const ni::DeviceInfo& info = made->device.getDeviceInfo();
  made->facts.name = made->facts.recording
                         ? request.source
                         : rt::printable(std::string(info.getVendor()) + " " + info.getName());
  if (!made->facts.recording) {
    made->gone = std::make_unique<GoneListener>(info.getUri());
    ni::OpenNI::addDeviceDisconnectedListener(made->gone.get());
  }
  if (auto opened = made->openDepth(request); !opened)
    return std::unexpected(who + ": " + opened.error());
  if (request.colour) made->openColour(request);
  made->settle();
  if (made->depth.start() != ni::STATUS_OK)
    return std::unexpected(who + ": depth does not start (" + reason() +
                           "): plug it into another USB port, without a hub");
  if (made->facts.colour && made->colour.start() != ni::STATUS_OK) {
    made->facts.remarks.push_back("colour does not start (" + reason() +
                                  "); depth goes on without it");
    made->facts.colour = false;
    made->colour.destroy();
  }
  return std::unique_ptr<Device>(new Device(std::move(made)));
}

std::expected<void, std::string> Device::Implementation::openDepth(const DeviceRequest& request) {
  if (depth.create(device, ni::SENSOR_DEPTH) != ni::STATUS_OK)
    return std::unexpected("it has no depth (" + reason() + ")");
  if (!facts.recording) {
    const Modes modes = modesOf(depth.getSensorInfo(), ni::PIXEL_FORMAT_DEPTH_1_MM);
    const auto best = nearestMode(modes.ours, request.mode);
    if (!best) return std::unexpected("it has no depth in millimetres: choose another sensor");
    if (modes.ours[*best] != request.mode) {
      facts.remarks.push_back("it has no " + sizeOf(request.mode) + ": runs " +
                              sizeOf(modes.ours[*best]));
    }
    if (depth.setVideoMode(modes.theirs[*best]) != ni::STATUS_OK)
      return std::unexpected("refuses " + sizeOf(modes.ours[*best]) + " (" + reason() + ")");
  }
  const ni::VideoMode mode = depth.getVideoMode();
  if (mode.getPixelFormat() != ni::PIXEL_FORMAT_DEPTH_1_MM)
    return std::unexpected("its depth is not in millimetres: choose another sensor or recording");
  facts.width_px = modeOf(mode).width_px;
  facts.height_px = modeOf(mode).height_px;
  facts.lens = lensOf(depth);
  const std::uint32_t rate_hz = std::max(1U, modeOf(mode).rate_hz);
  pairs.emplace(500'000 / rate_hz);
  return {};
}

/// Colour of the same size as depth; without it depth goes on alone.
void Device::Implementation::openColour(const DeviceRequest& request) {
  if (device.getSensorInfo(ni::SENSOR_COLOR) == nullptr ||
      colour.create(device, ni::SENSOR_COLOR) != ni::STATUS_OK) {
    facts.remarks.emplace_back("it has no colour; depth goes on without it");
    return;
  }
  if (!facts.recording) {
    const Modes modes = modesOf(colour.getSensorInfo(), ni::PIXEL_FORMAT_RGB888);
    const auto best =
        nearestMode(modes.ours, {facts.width_px, facts.height_px, request.mode.rate_hz});
    if (best) colour.setVideoMode(modes.theirs[*best]);
  }
  const ni::VideoMode mode = colour.getVideoMode();
  facts.colour = mode.getPixelFormat() == ni::PIXEL_FORMAT_RGB888 &&
                 modeOf(mode).width_px == facts.width_px &&
                 modeOf(mode).height_px == facts.height_px;
  if (facts.colour) {
    facts.colour_lens = lensOf(colour);
    return;
  }
  facts.remarks.push_back("its colour has no RGB of " + std::to_string(facts.width_px) + "x" +
                          std::to_string(facts.height_px) +
                          ", the size of its depth; depth goes on without it");
  colour.destroy();
}

/// Registered, in step, not mirrored; played picture by picture if it is a recording.
void Device::Implementation::settle() {
  if (facts.recording) {
    ni::PlaybackControl* play = device.getPlaybackControl();
    play->setSpeed(-1);  // the next picture when we ask, never by the clock
    play->setRepeatEnabled(false);
    return;  // registered or not, as it was recorded
  }
  for (ni::VideoStream* stream : {&depth, &colour})
    if (stream->isValid()) stream->setMirroringEnabled(false);
  if (!facts.colour) return;
  if (!device.isImageRegistrationModeSupported(ni::IMAGE_REGISTRATION_DEPTH_TO_COLOR) ||
      device.setImageRegistrationMode(ni::IMAGE_REGISTRATION_DEPTH_TO_COLOR) != ni::STATUS_OK) {
    facts.remarks.emplace_back(
        "its driver does not register depth to colour: both differ by some pixels");
  }
  // Registered depth is seen through the colour camera's lens.
  if (device.getImageRegistrationMode() == ni::IMAGE_REGISTRATION_DEPTH_TO_COLOR &&
      colour.getHorizontalFieldOfView() > 0 && colour.getVerticalFieldOfView() > 0) {
    facts.lens = facts.colour_lens;
  }
  device.setDepthColorSyncEnabled(true);  // not every driver can: the pairs are made by stamps
}

std::expected<void, std::string> Device::record(const std::string& path) {
  Implementation& made = *implementation_;
  if (made.recorder.create(path.c_str()) != ni::STATUS_OK ||
      made.recorder.attach(made.depth) != ni::STATUS_OK ||
      (made.facts.colour && made.recorder.attach(made.colour) != ni::STATUS_OK) ||
      made.recorder.start() != ni::STATUS_OK) {
    return std::unexpected(path + ": cannot be recorded (" + reason() + ")");
  }
  return writeStreamCount(path, made.facts.colour ? 2 : 1, 5s);
}

Device::Answer Device::next(rt::Nanoseconds timeout, DevicePair& pair) {
  Implementation& made = *implementation_;
  made.lent = {};
  const auto emit = [&made](Implementation::Picture depth,
                            std::optional<Implementation::Picture> colour) {
    made.ready.push_back({std::move(depth), std::move(colour)});
  };
  if (made.facts.recording) timeout = std::max(timeout, kEndOfFile);
  const rt::Timestamp until = rt::now() + timeout;
  while (made.ready.empty()) {
    if (made.gone && made.gone->gone()) return Answer::kGone;
    const auto left_ms =
        std::chrono::duration_cast<std::chrono::milliseconds>(until - rt::now()).count();
    if (left_ms <= 0) {
      if (!made.facts.recording) return Answer::kNothing;
      made.pairs->flush(emit);  // the last one may have lost its colour
      if (made.ready.empty()) return Answer::kEnd;
      break;
    }
    std::array<ni::VideoStream*, 2> streams = {&made.depth, &made.colour};
    int which = -1;
    const ni::Status status = ni::OpenNI::waitForAnyStream(
        streams.data(), made.facts.colour ? 2 : 1, &which, static_cast<int>(left_ms));
    if (status != ni::STATUS_OK) continue;
    Implementation::Picture picture{{}, rt::now()};
    // Only after the wait: without a picture readFrame() would block forever.
    if (streams[static_cast<std::size_t>(which)]->readFrame(&picture.frame) != ni::STATUS_OK ||
        !picture.frame.isValid()) {
      continue;
    }
    const std::uint64_t stamp_us = picture.frame.getTimestamp();
    const ni::VideoMode mode = picture.frame.getVideoMode();
    if (modeOf(mode).width_px != made.facts.width_px ||
        modeOf(mode).height_px != made.facts.height_px) {
      continue;
    }
    if (which == 0 && made.facts.colour)
      made.pairs->onDepth(stamp_us, std::move(picture), emit);
    else if (which == 0)
      emit(std::move(picture), {});
    else
      made.pairs->onColour(stamp_us, std::move(picture), emit);
  }
  made.lend(pair);
  return Answer::kPair;
}

namespace {

/// The picture's rows without padding; in place where there is none.
template <class Value>
std::span<const Value> rowsOf(const ni::VideoFrameRef& frame, std::size_t values_per_row,
                              std::vector<Value>& space) {
  const auto height = static_cast<std::size_t>(frame.getHeight());
  const auto stride = static_cast<std::size_t>(frame.getStrideInBytes());
  const std::size_t row_bytes = values_per_row * sizeof(Value);
  const auto* bytes = static_cast<const std::byte*>(frame.getData());
  if (stride == row_bytes) return {reinterpret_cast<const Value*>(bytes), values_per_row * height};
  space.resize(values_per_row * height);
  for (std::size_t y = 0; y < height; ++y)
    std::memcpy(&space[y * values_per_row], bytes + y * stride, row_bytes);
  return space;
}

}  // namespace

void Device::Implementation::lend(DevicePair& pair) {
  lent = std::move(ready.front());
  ready.pop_front();
  pair = {.depth_mm = rowsOf(lent.depth.frame, facts.width_px, depth_rows),
          .number = static_cast<std::uint64_t>(std::max(0, lent.depth.frame.getFrameIndex())),
          .stamp_us = lent.depth.frame.getTimestamp(),
          .frame_ready = lent.depth.at};
  if (!lent.colour) return;
  pair.colour_stamp_us = lent.colour->frame.getTimestamp();
  pair.colour_rgb = rowsOf(lent.colour->frame, std::size_t{3} * facts.width_px, colour_rows);
  pair.frame_ready = std::max(pair.frame_ready, lent.colour->at);
}

}  // namespace hal::openni
