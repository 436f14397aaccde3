#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace emulator::studio {

/// Files of one scene in a folder that all scenes share, under a limit for all together: the scenes
/// that were not used for the longest time go first.
///
/// Threads  One.
/// Errors   A damaged file is reported on stderr, deleted and drawn again. A full disk or a reached
///          limit is reported once, and nothing more is stored.
class SceneCache {
 public:
  /// @p key  names the scene and everything that its pictures depend on.
  SceneCache(const std::filesystem::path& root, const std::string& key, std::uint64_t limit_bytes);
  /// Keeps nothing.
  SceneCache() = default;

  [[nodiscard]] std::optional<std::vector<std::byte>> load(const std::string& name) const;
  void store(const std::string& name, std::span<const std::byte> bytes);

 private:
  void giveUp(const std::string& why);
  [[nodiscard]] bool makeRoom(std::uint64_t bytes) const;

  std::filesystem::path root_;
  std::filesystem::path folder_;  // empty: stores nothing
  std::uint64_t limit_bytes_ = 0;
};

/// kagami/studio in the user's cache.
[[nodiscard]] std::filesystem::path usualCache();

/// Of a scene's key and of what files hold: FNV-1a over words of eight bytes.
[[nodiscard]] std::uint64_t digest(std::span<const std::byte> bytes);

}  // namespace emulator::studio
