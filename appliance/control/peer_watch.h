#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include <systemd/sd-bus.h>

namespace appliance {

/// Notices that programs which asked for something have left the bus.
///
/// Threads  The event loop's.
class PeerWatch {
 public:
  /// @p gone gets the unique name of each watched peer that left.
  explicit PeerWatch(std::function<void(const std::string& peer)> gone) : gone_(std::move(gone)) {}
  PeerWatch(const PeerWatch&) = delete;
  PeerWatch& operator=(const PeerWatch&) = delete;

  /// Watches @p peer, a unique name, from now on. Returns a negative errno if that is impossible.
  [[nodiscard]] int add(sd_bus* bus, const std::string& peer);
  void remove(const std::string& peer) { watched_.erase(peer); }

  /// The bus is gone, and every peer with it.
  void loseAll();

 private:
  struct TrackCloser {
    void operator()(sd_bus_track* track) const { sd_bus_track_unref(track); }
  };
  using Track = std::unique_ptr<sd_bus_track, TrackCloser>;

  static int onGone(sd_bus_track* track, void* watch) noexcept;
  void leave(const std::string& peer);

  std::function<void(const std::string&)> gone_;
  std::map<std::string, Track> watched_;
};

}  // namespace appliance
