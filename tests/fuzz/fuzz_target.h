#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

#include "rt/printable.h"

/// What a fuzz target defines: takes one input from outside, whatever it holds. A fault is a crash,
/// a sanitizer's finding, or a promise of the parser's header that require() sees broken.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace fuzz {

/// A broken promise ends the process, as libFuzzer wants it.
inline void require(bool promise, const char* what) {
  if (promise) return;
  (void)std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

/// Every message of ours is one line for a person, fit for terminals and D-Bus.
inline void requireOneLine(const std::string& message) {
  require(!message.empty(), "an error says something");
  require(message == rt::printable(message, message.size()), "an error is one printable line");
}

inline std::string_view text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Takes an input apart, number by number; past its end everything is zero.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}

  [[nodiscard]] bool empty() const { return rest_.empty(); }
  [[nodiscard]] std::span<const std::uint8_t> take(std::size_t bytes) {
    const auto taken = rest_.first(std::min(bytes, rest_.size()));
    rest_ = rest_.subspan(taken.size());
    return taken;
  }
  /// Big-endian, so that a person can write a corpus by hand.
  template <class T>
  [[nodiscard]] T number() {
    std::uint64_t value = 0;
    for (const std::uint8_t byte : take(sizeof(T))) value = value << 8 | byte;
    return static_cast<T>(value);
  }

 private:
  std::span<const std::uint8_t> rest_;
};

}  // namespace fuzz
