#include "appliance/depth/depth_snapshot.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <deque>
#include <memory>
#include <system_error>
#include <utility>

#include "appliance/words/phrase.h"
#include "hal/backends.h"

namespace appliance {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr rt::Nanoseconds kLook = 100ms;  // how often the stop token is looked at

hal::DepthFrame frameOf(const PinnedDepth& pinned, std::uint64_t number) {
  const StoredDepth& picture = pinned.picture;
  return {.depth_mm = pinned.depth_mm,
          .colour_rgb = pinned.colour_rgb,
          .width_px = picture.width_px,
          .height_px = picture.height_px,
          .lens = picture.lens,
          .colour_lens = picture.colour_lens,
          .number = number,
          .exposure = picture.exposure,
          .colour_exposure = picture.colour_exposure,
          .frame_ready = picture.frame_ready};
}

/// Takes pairs from the board, pinned ahead of the disk, so that a slow one costs none.
class PairSource {
 public:
  PairSource(DepthReader& reader, std::uint32_t pairs) : reader_(reader), wanted_(pairs) {
    reader_.seekBack(pairs);
  }

  /// None: no pair came before @p deadline.
  [[nodiscard]] std::optional<PinnedDepth> next(rt::Timestamp deadline) {
    pinAhead();
    while (ahead_.empty() && reader_.waitUntil(deadline)) pinAhead();
    if (ahead_.empty()) return std::nullopt;
    PinnedDepth pair = std::move(ahead_.front());
    ahead_.pop_front();
    return pair;
  }

 private:
  void pinAhead() {
    // The pair that was written last has given its pin back.
    while (pinned_ < wanted_ && ahead_.size() < kSnapshotPins) {
      auto pair = reader_.tryNext();
      if (!pair) return;
      ahead_.push_back(std::move(*pair));
      ++pinned_;
    }
  }

  DepthReader& reader_;
  const std::uint32_t wanted_;
  std::uint32_t pinned_ = 0;
  std::deque<PinnedDepth> ahead_;
};

/// The folder of a snapshot that is not whole goes with this object.
class UnfinishedFolder {
 public:
  explicit UnfinishedFolder(fs::path folder) : folder_(std::move(folder)) {}
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;
  ~UnfinishedFolder() {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
  }
  void keep() { folder_.clear(); }

 private:
  fs::path folder_;
};

std::string sizeOf(const StoredDepth& picture) {
  return std::to_string(picture.width_px) + "x" + std::to_string(picture.height_px);
}

}  // namespace

std::uint64_t RisingNumbers::of(std::uint64_t sensor_number) {
  const bool rises = sensors_last_ && sensor_number > *sensors_last_;
  const std::uint64_t step = rises ? sensor_number - *sensors_last_ : 1;
  last_ = sensors_last_ ? last_ + step : sensor_number;
  sensors_last_ = sensor_number;
  return last_;
}

std::expected<std::string, std::string> writeDepthSnapshot(
    DepthReader& reader, const DepthSnapshotOrder& order,
    const std::function<void(double)>& progress, const std::stop_token& stop) {
  PairSource source(reader, order.pairs);
  RisingNumbers numbers;
  UnfinishedFolder unfinished(order.folder);
  const auto recorder = hal::makeDepthRecorder(order.folder);
  std::string size;
  rt::Timestamp patient_until = rt::now() + order.patience;
  for (std::uint32_t written = 0;;) {
    if (stop.stop_requested())
      return textOf(phrase<Word::kSnapshotCancelled>(written, order.pairs));
    if (written == order.pairs) break;
    const auto pair = source.next(std::min(rt::now() + kLook, patient_until));
    if (!pair && rt::now() < patient_until) continue;
    if (!pair) return std::unexpected(textOf(phrase<Word::kSnapshotStarved>(written, order.pairs)));
    if (written == 0) size = sizeOf(pair->picture);
    if (sizeOf(pair->picture) != size)
      return std::unexpected(
          textOf(phrase<Word::kSnapshotSize>(size, sizeOf(pair->picture), written, order.pairs)));
    const auto done =
        recorder->write(frameOf(*pair, numbers.of(pair->picture.sensor_number)), order.sensor);
    if (!done) return std::unexpected(done.error());
    ++written;
    patient_until = rt::now() + order.patience;
    progress(static_cast<double>(written) / order.pairs);
  }
  unfinished.keep();
  return order.folder.string();
}

fs::path snapshotFolder(const fs::path& parent) {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  std::array<char, 32> name{};
  (void)std::strftime(name.data(), name.size(), "snapshot-%Y%m%dT%H%M%SZ", &utc);
  fs::path folder = parent / name.data();
  std::error_code ignored;
  for (int again = 2; fs::exists(folder, ignored); ++again)
    folder = parent / (std::string(name.data()) + "-" + std::to_string(again));
  return folder;
}

}  // namespace appliance
