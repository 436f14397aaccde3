#include "appliance/control/peer_watch.h"

#include <algorithm>
#include <cerrno>
#include <exception>
#include <utility>

namespace appliance {

int PeerWatch::add(sd_bus* bus, const std::string& peer) {
  if (watched_.contains(peer)) return 0;
  sd_bus_track* made = nullptr;
  if (const int r = sd_bus_track_new(bus, &made, onGone, this); r < 0) return r;
  Track track(made);
  if (const int r = sd_bus_track_add_name(made, peer.c_str()); r < 0) return r;
  watched_.emplace(peer, std::move(track));
  return 0;
}

int PeerWatch::onGone(sd_bus_track* track, void* watch) noexcept {
  auto& self = *static_cast<PeerWatch*>(watch);
  const auto found = std::ranges::find_if(
      self.watched_, [track](const auto& peer) { return peer.second.get() == track; });
  if (found == self.watched_.end()) return 0;
  try {
    self.leave(std::string(found->first));
  } catch (const std::exception&) {
    return -ENOMEM;
  }
  return 0;
}

void PeerWatch::leave(const std::string& peer) {
  watched_.erase(peer);
  gone_(peer);
}

void PeerWatch::loseAll() {
  while (!watched_.empty()) leave(std::string(watched_.begin()->first));
}

}  // namespace appliance
