#pragma once

#include <atomic>
#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/emulated/rig/overlay.h"
#include "hal/emulated/studio/studio_options.h"
#include "hal/emulated/studio/studio_rig.h"
#include "rt/clock.h"

namespace emulator::studio {

class RgbdTrack;

/// The scene's pictures: the empty hall of every camera, and one moment after the other over it,
/// taken from the cache or drawn by threads of the lowest priority.
///
/// Threads  Pictures are read by one thread, while our own draw further ones.
/// Memory   Locked; up to 8 MB for each moment of 20 cameras, usually 3. Refused beyond half of
///          what is free.
/// Errors   Needs EGL and OpenGL ES 3. If memory is too short for the whole play, a line on
///          stderr says so and what is ready is shown.
class Play {
 public:
  /// How far the preparation is, 0..1, and what is being done.
  using Progress = std::function<void(double, const char*)>;

  /// Returns as soon as there is enough to begin with.
  [[nodiscard]] static std::expected<std::unique_ptr<Play>, std::string> begin(
      const StudioOptions& options, const Progress& progress);
  ~Play();

  [[nodiscard]] const StudioRig& rig() const;
  /// Moments of the whole scene.
  [[nodiscard]] std::uint32_t momentCount() const;
  /// Number of moments ready to show, in whole rounds of a hall's variants. With
  /// StudioOptions::only: of the chosen moments.
  [[nodiscard]] std::uint32_t readyCount() const;
  /// What a camera sees of a moment that is ready, over its empty hall. It stays where it is.
  [[nodiscard]] const Overlay& overlay(std::uint32_t moment, std::uint32_t camera) const;
  /// A camera's empty hall; each call makes it again.
  [[nodiscard]] std::vector<std::uint8_t> background(std::uint32_t camera,
                                                     std::uint32_t variant) const;
  /// What the depth sensor sees; nullptr without one.
  [[nodiscard]] const RgbdTrack* rgbd() const;
  /// A camera receives pictures: the drawing threads rest for a second, because drawing and the box
  /// would slow each other down.
  ///
  /// Threads  Any. RT: one store.
  void rest(rt::Timestamp now);
  /// Until so many moments are ready, or drawing has ended. For tests and tools.
  void waitFor(std::uint32_t moments) const;

 private:
  struct State;
  explicit Play(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace emulator::studio
