#include "appliance/capture/camera_supervisor.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "appliance/capture/liveness.h"

namespace appliance {
namespace {

using namespace std::chrono_literals;

constexpr rt::Nanoseconds kAnswerTimeout = 100ms;
constexpr rt::Nanoseconds kWatchEvery = 50ms;  // a streaming camera
constexpr rt::Nanoseconds kLookEvery = 10ms;   // any other
constexpr std::uint64_t kMostJudged = 64;

std::string watchThreadName(std::size_t camera) {
  char name[16];
  std::snprintf(name, sizeof name, "watch%02zu", (camera + 1) % 100);
  return name;
}

}  // namespace

std::expected<void, std::string> CameraSupervisor::start(std::size_t camera) {
  auto started = rt::Thread::start({.name = watchThreadName(camera)},
                                   [this](const std::stop_token& stop) { run(stop); });
  if (!started) {
    return std::unexpected(
        withId(phrase<Word::kWatchRefused>(watchThreadName(camera), started.error().where)));
  }
  thread_ = std::move(*started);
  return {};
}

bool CameraSupervisor::waitSettled(rt::Timestamp deadline) {
  std::unique_lock lock(mutex_);
  return changed_.wait_until(lock, deadline, [this] { return settled_; });
}

void CameraSupervisor::requestStop() {
  if (thread_.joinable()) thread_.requestStop();
}

void CameraSupervisor::stop() {
  thread_ = {};
}

CameraHealth CameraSupervisor::health() const {
  const std::scoped_lock lock(mutex_);
  return health_;
}

std::vector<Phrase> CameraSupervisor::remarks() const {
  const std::scoped_lock lock(mutex_);
  return remarks_;
}

std::vector<Phrase> CameraSupervisor::remarksNow() {
  if (!camera_) return {};
  std::vector<Phrase> remarks;
  for (const std::string& remark : camera_->remarks())
    remarks.push_back(phrase<Word::kCameraNote>(remark));
  const hal::CameraStatistics counted = camera_->statistics();
  packets_.take(counted);
  if (large_packet_loss_.update(counted)) {
    remarks.push_back(phrase<Word::kCameraLargePackets>(access_.name));
  }
  return remarks;
}

std::optional<rt::Nanoseconds> CameraSupervisor::silentFor(rt::Timestamp now) const {
  const rt::Timestamp last = collector_.counts().last_stored;
  if (last == rt::Timestamp{}) return std::nullopt;
  return now - last;
}

void CameraSupervisor::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const CameraAction action = machine_.step(rt::now(), facts());
    carryOut(action);
    std::vector<Phrase> remarks = remarksNow();
    std::unique_lock lock(mutex_);
    health_ = machine_.health();
    if (camera_) remarks_ = std::move(remarks);  // what a lost camera had stays, it may be why
    settled_ = machine_.settled();
    changed_.notify_all();
    if (action != CameraAction::kNone) continue;
    const bool well = health_.state == CameraState::kStreaming;
    changed_.wait_for(lock, stop, well ? kWatchEvery : kLookEvery, [] { return false; });
  }
  camera_.reset();
}

void CameraSupervisor::carryOut(CameraAction action) {
  switch (action) {
    case CameraAction::kNone:
      break;
    case CameraAction::kProbe: {
      const hal::CameraProbe probe = access_.probe(kAnswerTimeout);
      machine_.probed(rt::now(), probe);
      break;
    }
    case CameraAction::kOpen: {
      auto opened = access_.open();
      if (opened) camera_ = std::move(*opened);
      machine_.opened(rt::now(), opened ? "" : opened.error());
      break;
    }
    case CameraAction::kStart: {
      collector_.restart();
      const auto started = camera_->start(collector_, frames_.slots(), frames_.fillingSlots());
      machine_.started(rt::now(), started ? "" : started.error(), facts());
      break;
    }
    case CameraAction::kClose:
      camera_.reset();
      machine_.closed(rt::now());
      break;
  }
}

CameraFacts CameraSupervisor::facts() const {
  const CollectorCounts counts = collector_.counts();
  CameraFacts facts{.fired = edges_.newest(),
                    .stored = frames_.newest(),
                    .damaged = counts.damaged(),
                    .extra = counts.unattributed};
  if (facts.fired <= kTriggersOnTheWire) return facts;
  const std::uint64_t newest = facts.fired - kTriggersOnTheWire;
  // Older frames than the history keeps say nothing.
  const std::uint64_t kept = std::max<std::uint64_t>(frames_.sets(), 4) - 3;
  facts.judged = static_cast<std::uint32_t>(std::min({newest, kept, kMostJudged}));
  for (std::uint32_t i = 0; i < facts.judged; ++i) {
    if (frames_.holds(newest - i)) facts.brought |= std::uint64_t{1} << i;
  }
  return facts;
}

}  // namespace appliance
