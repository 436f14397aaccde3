#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "tests/bench/reception/receiver.h"

namespace bench {

/// One stream for each camera. A Stream has open(profile, setup) and counts its frames().
template <class Stream>
class StreamReceiver final : public Receiver {
 public:
  explicit StreamReceiver(std::vector<std::unique_ptr<Stream>> streams)
      : streams_(std::move(streams)) {}

  [[nodiscard]] std::uint64_t frames() const override {
    std::uint64_t frames = 0;
    for (const auto& stream : streams_) frames += stream->frames();
    return frames;
  }

 private:
  std::vector<std::unique_ptr<Stream>> streams_;
};

template <class Stream>
[[nodiscard]] MadeReceiver openStreams(const ReceptionSetup& setup) {
  std::vector<std::unique_ptr<Stream>> streams;
  for (const hal::CameraProfile& profile : setup.cameras) {
    streams.push_back(std::make_unique<Stream>());
    if (auto opened = streams.back()->open(profile, setup); !opened) {
      return std::unexpected(opened.error());
    }
  }
  return std::make_unique<StreamReceiver<Stream>>(std::move(streams));
}

}  // namespace bench
