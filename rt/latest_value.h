#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "rt/annotations.h"
#include "rt/spsc_ring.h"

namespace rt {

/// Newest-wins hand-over from exactly one writer to exactly one reader thread: a triple buffer.
///
/// A value that was not taken before the next one came is overwritten: that is
/// the policy, not a loss. For "every value counts" use rt::SpscRing, for many
/// readers rt::SharedValue.
///
/// Threads  publish(): the writer. tryTake(), latest(): the reader.
/// RT       Every member is wait-free; storage lives inside the object.
/// Memory   Writer and reader own one buffer each and swap it against the middle
///          one by a single acquire-release exchange, so no buffer is ever shared.
template <typename T>
class LatestValue {
  static_assert(std::is_trivially_copyable_v<T>, "copies must not allocate or lock");

 public:
  explicit LatestValue(const T& initial = T{}) { buffers_.fill(Buffer{initial}); }

  void publish(const T& value) RT_SAFE {
    buffers_[back_].value = value;
    back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndexMask;
  }

  /// The newest value, when one came since the last call of tryTake() or latest().
  [[nodiscard]] std::optional<T> tryTake() RT_SAFE {
    if (!fetch()) return std::nullopt;
    return buffers_[front_].value;
  }

  /// The newest value published so far; the initial one before the first publish().
  /// The reference holds until the reader's next call.
  [[nodiscard]] const T& latest() RT_SAFE {
    (void)fetch();
    return buffers_[front_].value;
  }

 private:
  static constexpr std::uint32_t kFresh = 4;
  static constexpr std::uint32_t kIndexMask = 3;

  struct alignas(kCacheLineBytes) Buffer {
    T value;
  };

  bool fetch() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndexMask;
    return true;
  }

  std::array<Buffer, 3> buffers_;
  alignas(kCacheLineBytes) std::uint32_t back_ = 0;                // the writer's
  alignas(kCacheLineBytes) std::atomic<std::uint32_t> middle_{1};  // index, and whether it is new
  alignas(kCacheLineBytes) std::uint32_t front_ = 2;               // the reader's
};

}  // namespace rt
