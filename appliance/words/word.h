#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace appliance {

/// Everything that a person may read, by name; english.inc says what it means.
enum class Word : std::uint16_t {
#define WORD(identifier, pattern) identifier,
#include "appliance/words/english.inc"
#undef WORD
};

namespace words {

struct Definition {
  std::string_view identifier;  ///< "kCameraSilent"
  std::string_view english;
};

inline constexpr auto kTable = std::to_array<Definition>({
#define WORD(identifier, pattern) {#identifier, pattern},
#include "appliance/words/english.inc"
#undef WORD
});

}  // namespace words

[[nodiscard]] constexpr std::string_view englishOf(Word word) {
  return words::kTable[static_cast<std::size_t>(word)].english;
}

/// "camera-silent": the same in every language, for journals and programs.
[[nodiscard]] std::string_view idOf(Word word);

}  // namespace appliance
