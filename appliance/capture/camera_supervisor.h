#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <vector>

#include "appliance/capture/camera_machine.h"
#include "appliance/capture/camera_state.h"
#include "appliance/capture/collector.h"
#include "appliance/capture/edge_board.h"
#include "appliance/capture/frame_history.h"
#include "appliance/capture/large_packet_loss.h"
#include "appliance/capture/packet_counts.h"
#include "appliance/words/phrase.h"
#include "hal/camera.h"
#include "hal/camera_probe.h"
#include "rt/thread.h"

namespace appliance {

/// How one camera is reached.
struct CameraAccess {
  /// Waits no longer than the given time.
  std::function<hal::CameraProbe(rt::Nanoseconds)> probe;
  /// May take seconds if the camera dies meanwhile.
  std::function<std::expected<std::unique_ptr<hal::Camera>, std::string>()> open;
  std::string name;                 ///< for remarks
  std::uint32_t frame_packets = 0;  ///< on the wire, leader and trailer included
};

/// Keeps one camera of the rig streaming, however often it dies: carries out what its
/// CameraMachine decides, on a thread of its own, so that a dead camera's long silences delay no
/// other camera. The slots that the camera was filling when it died are the ones it fills first
/// when it is back.
///
/// Threads  start(), requestStop(), stop(): the owner. health(): any. The camera, and the collector
///          while the camera is stopped, belong to its thread, `watchNN`.
/// RT       Not safe. The receive threads never wait for it.
/// Memory   Everything given outlives the supervisor.
class CameraSupervisor {
 public:
  CameraSupervisor(CameraAccess access, Collector& collector, CameraFrames& frames,
                   const EdgeBoard& edges)
      : access_(std::move(access)),
        collector_(collector),
        frames_(frames),
        edges_(edges),
        large_packet_loss_(access_.frame_packets) {}
  ~CameraSupervisor() { stop(); }
  CameraSupervisor(const CameraSupervisor&) = delete;
  CameraSupervisor& operator=(const CameraSupervisor&) = delete;

  /// @p camera: from 0, for the thread's name. Errors: no thread could be made.
  [[nodiscard]] std::expected<void, std::string> start(std::size_t camera);

  /// Until the first attempt to stream has ended, well or not; false at @p deadline.
  [[nodiscard]] bool waitSettled(rt::Timestamp deadline);

  /// Releases the camera as soon as possible. stop() waits for that, which takes seconds for a dead
  /// one: request all stops before waiting for one.
  void requestStop();
  void stop();

  [[nodiscard]] CameraHealth health() const;
  /// What is wrong at the camera although it streams. Any thread.
  [[nodiscard]] std::vector<Phrase> remarks() const;
  [[nodiscard]] const PacketCounts& packets() const { return packets_; }
  /// Since its last stored frame; nothing before the first.
  [[nodiscard]] std::optional<rt::Nanoseconds> silentFor(rt::Timestamp now) const;

 private:
  void run(const std::stop_token& stop);
  void carryOut(CameraAction action);
  [[nodiscard]] std::vector<Phrase> remarksNow();
  [[nodiscard]] CameraFacts facts() const;

  CameraAccess access_;
  Collector& collector_;
  CameraFrames& frames_;
  const EdgeBoard& edges_;

  CameraMachine machine_;                // the thread's
  std::unique_ptr<hal::Camera> camera_;  // likewise
  LargePacketLoss large_packet_loss_;    // likewise
  PacketCounts packets_;                 // the thread's to write

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  CameraHealth health_;          // guarded by mutex_
  std::vector<Phrase> remarks_;  // likewise
  bool settled_ = false;         // likewise
  rt::Thread thread_;            // last: joined before anything else goes
};

}  // namespace appliance
