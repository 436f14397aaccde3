#pragma once

#include <cstdint>
#include <optional>
#include <random>

namespace emulator {

/// Packets that the emulated wire swallows on purpose, the same ones for the same seed.
class LossModel {
 public:
  LossModel(double probability, std::uint64_t seed) : lost_(probability), engine_(seed) {}
  [[nodiscard]] bool loses() { return lost_.p() > 0 && lost_(engine_); }

 private:
  std::bernoulli_distribution lost_;
  std::mt19937_64 engine_;
};

/// What the wire of one camera does to its stream packets beside what the whole rig's does.
class PacketFaults {
 public:
  static constexpr std::uint32_t kAnySize = 0xffff'ffff;

  /// @p rig: of all cameras; outlives this object.
  PacketFaults(LossModel& rig, std::uint64_t seed) : rig_(&rig), engine_(seed) {}

  void setLoss(double probability) { loss_ = probability; }
  void setReorder(double probability) { reorder_ = probability; }
  void setDuplicate(double probability) { duplicate_ = probability; }
  /// Larger datagrams vanish; kAnySize: none.
  void setMtu(std::uint32_t bytes) { mtu_ = bytes; }
  void clear() {
    loss_ = reorder_ = duplicate_ = 0;
    mtu_ = kAnySize;
  }

  /// Whether packets leave in another order or number than asked for.
  [[nodiscard]] bool rearranges() const { return reorder_ > 0 || duplicate_ > 0; }
  /// Whether a datagram of that size gets through at all.
  [[nodiscard]] bool carries(std::uint32_t datagram_bytes) const { return datagram_bytes <= mtu_; }

  [[nodiscard]] bool loses() { return happens(loss_) || rig_->loses(); }
  [[nodiscard]] bool overtaken() { return happens(reorder_); }
  [[nodiscard]] bool doubled() { return happens(duplicate_); }

 private:
  [[nodiscard]] bool happens(double probability) {
    return probability > 0 && std::bernoulli_distribution(probability)(engine_);
  }

  LossModel* rig_;
  std::mt19937_64 engine_;
  double loss_ = 0;
  double reorder_ = 0;
  double duplicate_ = 0;
  std::uint32_t mtu_ = kAnySize;
};

}  // namespace emulator
