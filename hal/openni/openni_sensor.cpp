#include "hal/openni/openni_sensor.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include <poll.h>

namespace hal::openni {
namespace {

using namespace std::chrono_literals;
using Kind = WireMessage::Kind;

constexpr rt::Nanoseconds kSilence = 1s;  // of a streaming sensor
constexpr rt::Nanoseconds kForever = 24h * 365;

constexpr const char* kOtherVersion =
    "depth sensor: kagami-depth is of another version than this program: restart kagamid";

std::vector<std::string> argumentsOf(const DepthSensorSettings& settings) {
  return {"--source",  settings.source,
          "--drivers", settings.drivers,
          "--width",   std::to_string(settings.width_px),
          "--height",  std::to_string(settings.height_px),
          "--rate",    std::to_string(settings.rate_hz),
          "--colour",  settings.colour ? "true" : "false"};
}

}  // namespace

std::expected<std::unique_ptr<OpenniSensor>, std::string> OpenniSensor::open(
    const DepthSensorSettings& settings, const SensorOptions& options) {
  auto worker = WorkerProcess::start(argumentsOf(settings));
  if (!worker) return std::unexpected(worker.error());
  return std::unique_ptr<OpenniSensor>(new OpenniSensor(settings, options, std::move(*worker)));
}

OpenniSensor::OpenniSensor(DepthSensorSettings settings, SensorOptions options,
                           WorkerProcess worker)
    : settings_(std::move(settings)),
      options_(options),
      worker_(std::move(worker)),
      heard_(rt::now()) {
  status_.name = settings_.source;
}

DepthStatus OpenniSensor::status() const {
  const std::scoped_lock lock(mutex_);
  return status_;
}

std::optional<DepthFrame> OpenniSensor::waitFrame(rt::Nanoseconds timeout) {
  if (lent_ && worker_) worker_->release(*lent_);
  lent_.reset();
  const rt::Timestamp until = rt::now() + timeout;
  for (;;) {
    if (due_) {
      if (options_.play == Play::kRealTime && due_exposure_ > rt::now()) {
        std::this_thread::sleep_until(std::min(due_exposure_, until));
        if (due_exposure_ > rt::now()) return std::nullopt;
      }
      const WireMessage message = *std::exchange(due_, std::nullopt);
      lent_ = message.slot;
      return frameOf(message);
    }
    turn(until);
    if (!due_ && rt::now() >= until) return std::nullopt;
  }
}

void OpenniSensor::turn(rt::Timestamp until) {
  const auto pauseUntil = [until](rt::Timestamp at) {
    std::this_thread::sleep_until(std::min(at, until));
  };
  if (!worker_) {
    if (start_at_ > rt::now()) return pauseUntil(start_at_);
    auto worker = WorkerProcess::start(argumentsOf(settings_));
    if (!worker) {
      note([&](DepthStatus& status) { status.message = worker.error(); });
      start_at_ = rt::now() + pause_.next(RestartPause::End::kFailure);
      return;
    }
    worker_ = std::move(*worker);
    heard_ = rt::now();
  }
  Received received;
  switch (tryReceive(worker_->socket(), received)) {
    case ReceiveResult::kMessage:
      heard_ = rt::now();
      return onMessage(received);
    case ReceiveResult::kClosed:
      return lose("depth sensor: its driver crashed; starting it again");
    case ReceiveResult::kForeign:
      return lose(kOtherVersion);
    case ReceiveResult::kNothing:
      break;
  }
  if (rt::now() >= silentUntil()) {
    worker_->kill();
    return lose("depth sensor " + status_.name +
                " fell silent: starting it again; if that lasts, "
                "check its cable and power");
  }
  pollfd wire{.fd = worker_->socket(), .events = POLLIN, .revents = 0};
  const auto left = std::max<rt::Nanoseconds>(std::min(until, silentUntil()) - rt::now(), 0ns);
  const timespec limit{.tv_sec = left / 1s, .tv_nsec = (left % 1s).count()};
  (void)::ppoll(&wire, 1, &limit, nullptr);
}

rt::Timestamp OpenniSensor::silentUntil() const {
  if (streamed_ && worker_->hello().recording) return rt::now() + kForever;
  return heard_ + (streamed_ ? kSilence : options_.opening_patience);
}

void OpenniSensor::onMessage(Received& received) {
  const WireMessage& message = received.message;
  switch (message.kind) {
    case Kind::kNote:
      return note([&](DepthStatus& status) { status.message = message.textView(); });
    case Kind::kHello:
      return onHello(message, std::move(received.descriptor));
    case Kind::kFrame:
      return onFrame(message);
    case Kind::kEnd:
      return onEnd();
    case Kind::kFail:
      return lose(std::string(message.textView()),
                  message.unplugged ? RestartPause::End::kUnplugged : RestartPause::End::kFailure);
    case Kind::kAlive:
    case Kind::kRelease:
      return;
  }
}

void OpenniSensor::onHello(const WireMessage& message, rt::UniqueFd memory) {
  if (!worker_->accept(message, std::move(memory))) return lose(kOtherVersion);
  clock_.emplace();
  last_number_ = 0;
  note([&](DepthStatus& status) {
    status.name = message.textView();
    status.width_px = message.width_px;
    status.height_px = message.height_px;
    status.colour = message.colour;
  });
}

void OpenniSensor::onFrame(const WireMessage& message) {
  if (!worker_->accepted() || message.slot >= kWireSlots) return lose(kOtherVersion);
  due_ = message;
  setExposures(message);
  pause_.onPicture(rt::now());
  std::uint64_t missing = 0;
  if (last_number_ != 0 && message.number > last_number_ + 1)
    missing = message.number - last_number_ - 1;
  last_number_ = message.number;
  streamed_ = true;
  const bool came_back = std::exchange(was_lost_, false);
  note([&](DepthStatus& status) {
    if (came_back) ++status.returns;
    status.state = DepthState::kStreaming;
    status.lost += missing;
    ++status.frames;
    if (status.colour && !message.with_colour) ++status.without_colour;
    status.drift_ppm = worker_->hello().recording ? 0 : clock_->drift_ppm();
  });
}

/// Both pictures are stamped by the sensor's one clock.
void OpenniSensor::setExposures(const WireMessage& message) {
  due_colour_exposure_ = {};
  if (worker_->hello().recording) {
    due_exposure_ = play_clock_.due(message.stamp_us, rt::now());
    const std::chrono::microseconds apart(static_cast<std::int64_t>(message.colour_stamp_us) -
                                          static_cast<std::int64_t>(message.stamp_us));
    if (message.with_colour) due_colour_exposure_ = due_exposure_ + apart;
    return;
  }
  const rt::Timestamp arrival = rt::fromNs(message.frame_ready_ns);
  clock_->add(message.stamp_us, arrival);
  const auto exposureAt = [&](std::uint64_t stamp_us) {
    return std::min(clock_->earliestArrival(stamp_us), arrival) - settings_.latency;
  };
  due_exposure_ = exposureAt(message.stamp_us);
  if (message.with_colour) due_colour_exposure_ = exposureAt(message.colour_stamp_us);
}

void OpenniSensor::onEnd() {
  worker_.reset();
  streamed_ = false;
  play_clock_ = {};
  start_at_ = rt::now();
  if (settings_.repeat && last_number_ != 0) return;
  note([](DepthStatus& status) {
    status.state = DepthState::kEnded;
    if (status.frames == 0) status.message = status.name + ": holds no picture that can be played";
  });
  start_at_ = rt::now() + kForever;
}

void OpenniSensor::lose(const std::string& why, RestartPause::End end) {
  lent_.reset();  // gone with its worker
  due_.reset();
  worker_.reset();
  was_lost_ = was_lost_ || streamed_;
  streamed_ = false;
  note([&](DepthStatus& status) {
    if (status.frames > 0) status.state = DepthState::kLost;
    status.message = why;
  });
  start_at_ = rt::now() + pause_.next(end);
}

DepthFrame OpenniSensor::frameOf(const WireMessage& message) {
  const WireMessage& hello = worker_->hello();
  return {
      .depth_mm = worker_->depth(message.slot),
      .colour_rgb =
          message.with_colour ? worker_->colour(message.slot) : std::span<const std::uint8_t>{},
      .width_px = hello.width_px,
      .height_px = hello.height_px,
      .lens = hello.lens,
      .colour_lens = hello.colour_lens,
      .number = message.number,
      .exposure = due_exposure_,
      .colour_exposure = due_colour_exposure_,
      .frame_ready = worker_->hello().recording ? rt::now() : rt::fromNs(message.frame_ready_ns)};
}

}  // namespace hal::openni
