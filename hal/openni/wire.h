#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/depth_sensor.h"
#include "rt/unique_fd.h"

namespace hal::openni {

/// What the worker process and its supervisor say to each other: datagrams on a socket pair, the
/// pictures themselves in shared memory whose slots are lent to and fro.
struct WireMessage {
  enum class Kind : std::uint32_t {
    kNote,     ///< worker: text is what is less than asked for; empty: nothing any more
    kHello,    ///< worker: a sensor is open; carries the shared memory
    kFrame,    ///< worker: a slot is full
    kEnd,      ///< worker: the recording is over
    kFail,     ///< worker: text says why it gives up
    kRelease,  ///< supervisor: the slot is free again
    kAlive,    ///< worker: it waits for a sensor, and has not stopped
  };
  static constexpr std::size_t kTextBytes = 400;

  /// Grows with every change of this struct: after an upgrade an old supervisor may start a new
  /// worker.
  static constexpr std::uint32_t kVersion = 2;

  std::uint32_t version = kVersion;
  Kind kind{};
  std::uint32_t slot = 0;
  // kHello
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  bool colour = false;
  bool recording = false;
  DepthLens lens;
  DepthLens colour_lens;
  // kFrame
  bool with_colour = false;
  std::uint64_t number = 0;
  std::uint64_t stamp_us = 0;
  std::uint64_t colour_stamp_us = 0;
  std::int64_t frame_ready_ns = 0;

  // kFail
  bool unplugged = false;  ///< only the sensor went

  std::array<char, kTextBytes> text{};  ///< kHello: the sensor's name

  void setText(std::string_view to);
  [[nodiscard]] std::string_view textView() const;
};

inline constexpr std::uint32_t kWireSlots = 4;

/// Depth, then colour.
[[nodiscard]] inline std::size_t wireSlotBytes(std::uint32_t width_px, std::uint32_t height_px) {
  return std::size_t{width_px} * height_px * 5;
}

/// Says it; waits while the other end's queue is full. False: there is no other end any more.
[[nodiscard]] bool send(int socket, const WireMessage& message, int descriptor = -1);

struct Received {
  WireMessage message;
  rt::UniqueFd descriptor;
};
enum class ReceiveResult : std::uint8_t {
  kMessage,
  kNothing,
  kClosed,
  kForeign,  ///< the other end is of another version
};
/// Takes what is there without waiting.
[[nodiscard]] ReceiveResult tryReceive(int socket, Received& received);

}  // namespace hal::openni
