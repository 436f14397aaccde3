#include "hal/emulated/studio/scene_cache.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>

namespace emulator::studio {
namespace {

namespace fs = std::filesystem;

struct Head {
  std::uint64_t magic = 0x4b61'6761'6d69'5331;
  std::uint64_t bytes = 0;
  std::uint64_t digest = 0;
};

constexpr const char* kUsed = "used";  // its time says when the scene was opened last

std::uint64_t sizeOf(const fs::path& folder) {
  std::uint64_t sum = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    if (it->is_regular_file(error)) sum += it->file_size(error);
  }
  return sum;
}

}  // namespace

std::filesystem::path usualCache() {
  fs::path cache;
  if (const char* set = std::getenv("XDG_CACHE_HOME"); set != nullptr && *set != 0) {
    cache = set;
  } else {
    const char* home = std::getenv("HOME");
    cache = fs::path(home != nullptr && *home != 0 ? home : "/var/tmp") / ".cache";
  }
  return cache / "kagami" / "studio";
}

std::uint64_t digest(std::span<const std::byte> bytes) {
  std::uint64_t hash = 0xcbf2'9ce4'8422'2325;
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, &bytes[i], 8);
    hash = (hash ^ word) * 0x100'0000'01b3;
    hash ^= hash >> 29;
  }
  for (; i < bytes.size(); ++i)
    hash = (hash ^ static_cast<std::uint64_t>(bytes[i])) * 0x100'0000'01b3;
  return hash;
}

SceneCache::SceneCache(const fs::path& root, const std::string& key, std::uint64_t limit_bytes)
    : root_(root), limit_bytes_(limit_bytes) {
  char name[32];
  std::snprintf(name, sizeof name, "%016llx",
                static_cast<unsigned long long>(digest(std::as_bytes(std::span(key)))));
  folder_ = root / name;
  std::error_code error;
  fs::create_directories(folder_, error);
  std::ofstream used(folder_ / kUsed);
  used << key << "\n";
  used.flush();
  if (!used) giveUp("cannot write to " + folder_.string());
}

void SceneCache::giveUp(const std::string& why) {
  std::fprintf(stderr, "kagami-emulator: studio: %s: what is drawn from here on is not kept\n",
               why.c_str());
  folder_.clear();
}

std::optional<std::vector<std::byte>> SceneCache::load(const std::string& name) const {
  if (folder_.empty()) return std::nullopt;
  const fs::path path = folder_ / name;
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  Head head;
  const Head expected;
  std::error_code error;
  const std::uint64_t size = fs::file_size(path, error);
  std::vector<std::byte> bytes;
  bool good = !error && file.read(reinterpret_cast<char*>(&head), sizeof head) &&
              head.magic == expected.magic && head.bytes + sizeof head == size;
  if (good) {
    bytes.resize(head.bytes);
    good = file.read(reinterpret_cast<char*>(bytes.data()),
                     static_cast<std::streamsize>(bytes.size())) &&
           digest(bytes) == head.digest;
  }
  if (good) return bytes;
  std::fprintf(stderr, "kagami-emulator: studio: %s is damaged: it is deleted and drawn again\n",
               path.c_str());
  fs::remove(path, error);
  return std::nullopt;
}

bool SceneCache::makeRoom(std::uint64_t bytes) const {
  std::uint64_t total = sizeOf(root_);
  while (total + bytes > limit_bytes_) {
    fs::path oldest;
    fs::file_time_type oldest_time = fs::file_time_type::max();
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(root_, error)) {
      if (entry.path() == folder_ || !fs::exists(entry.path() / kUsed, error)) continue;
      const auto time = fs::last_write_time(entry.path() / kUsed, error);
      if (!error && time < oldest_time) {
        oldest_time = time;
        oldest = entry.path();
      }
    }
    if (oldest.empty()) return false;
    total -= std::min(total, sizeOf(oldest));
    fs::remove_all(oldest, error);
    if (error) return false;
  }
  return true;
}

void SceneCache::store(const std::string& name, std::span<const std::byte> bytes) {
  if (folder_.empty()) return;
  if (!makeRoom(bytes.size() + sizeof(Head))) {
    giveUp("the cache's limit is reached");
    return;
  }
  // Under another name until it is whole: a full disk or an end in between leaves no half file.
  const fs::path path = folder_ / name;
  const fs::path part = folder_ / (name + ".part");
  const Head head{.bytes = bytes.size(), .digest = digest(bytes)};
  std::error_code error;
  {
    std::ofstream file(part, std::ios::binary);
    file.write(reinterpret_cast<const char*>(&head), sizeof head);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    file.flush();
    if (!file) {
      const std::string why = std::strerror(errno);
      fs::remove(part, error);
      giveUp("cannot write " + path.string() + " (" + why + ")");
      return;
    }
  }
  fs::rename(part, path, error);
  if (error) giveUp("cannot write " + path.string() + " (" + error.message() + ")");
}

}  // namespace emulator::studio
