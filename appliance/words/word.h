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

/// "CameraSilent": for names on D-Bus.
[[nodiscard]] constexpr std::string_view nameOf(Word word) {
  return words::kTable[static_cast<std::size_t>(word)].identifier.substr(1);
}

/// Whether it is a remark in a backend's own words, "{note}": several may hold at the same time,
/// and they differ only by their texts.
[[nodiscard]] constexpr bool isNote(Word word) {
  return englishOf(word) == "{note}";
}

/// "camera-silent": the same in every language, for journals and programs.
[[nodiscard]] std::string_view idOf(Word word);

}  // namespace appliance
