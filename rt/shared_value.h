#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>

#include "rt/annotations.h"
#include "rt/spsc_ring.h"

namespace rt {

/// One value, written by one thread and read whole by any number: a sequence lock.
///
/// Readers leave no mark, so the writer never waits for them. For one reader,
/// rt::LatestValue has no retry.
///
/// Threads  store(): the writer. tryLoad(), load(): any.
/// RT       store() and tryLoad() are wait-free. load() repeats while the writer is
///          in the middle of store(): not for a thread that can preempt the writer.
/// Memory   The value crosses as atomic words: every word's release or acquire keeps
///          it between the two looks at the sequence number (even: at rest).
template <typename T>
class SharedValue {
  static_assert(std::is_trivially_copyable_v<T>, "the value crosses as words");

 public:
  explicit SharedValue(const T& initial = T{}) noexcept { store(initial); }

  void store(const T& value) RT_SAFE {
    Words words{};
    std::memcpy(words.data(), &value, sizeof(T));
    const auto sequence = sequence_.load(std::memory_order_relaxed);
    sequence_.store(sequence + 1, std::memory_order_relaxed);
    for (std::size_t i = 0; i < words.size(); ++i) {
      words_[i].store(words[i], std::memory_order_release);
    }
    sequence_.store(sequence + 2, std::memory_order_release);
  }

  /// One attempt; nullopt when the writer was in the middle of it.
  [[nodiscard]] std::optional<T> tryLoad() const RT_SAFE {
    const auto sequence = sequence_.load(std::memory_order_acquire);
    Words words{};
    for (std::size_t i = 0; i < words.size(); ++i) {
      words[i] = words_[i].load(std::memory_order_acquire);
    }
    if ((sequence & 1U) != 0 || sequence_.load(std::memory_order_relaxed) != sequence) {
      return std::nullopt;
    }
    T value{};
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
    return value;
  }

  [[nodiscard]] T load() const noexcept {
    for (;;) {
      if (const auto value = tryLoad()) return *value;
    }
  }

 private:
  using Words = std::array<std::uint64_t, (sizeof(T) + 7) / 8>;

  alignas(kCacheLineBytes) std::atomic<std::uint32_t> sequence_{0};
  std::array<std::atomic<std::uint64_t>, std::tuple_size_v<Words>> words_{};
};

}  // namespace rt
