#include "tests/lint/layer_table.h"

#include <algorithm>
#include <array>
#include <optional>
#include <regex>
#include <string_view>

namespace lint {
namespace {

struct Include {
  std::string header;
  bool angle = false;
};

std::optional<Include> includeOf(const std::string& line) {
  static const std::regex kPattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::smatch match;
  if (!std::regex_search(line, match, kPattern)) return std::nullopt;
  return Include{.header = match[2], .angle = match[1] == "<"};
}

/// What libc and the kernel give every program, the real-time substrate included.
bool isSystemHeader(const std::string& header) {
  static constexpr std::array<std::string_view, 5> kFolders = {"sys/", "linux/", "arpa/", "net/",
                                                               "netinet/"};
  static constexpr std::array<std::string_view, 27> kFiles = {
      "alloca.h",  "cxxabi.h", "dirent.h",  "dlfcn.h",  "errno.h",     "execinfo.h",  "fcntl.h",
      "getopt.h",  "grp.h",    "ifaddrs.h", "limits.h", "malloc.h",    "immintrin.h", "poll.h",
      "pthread.h", "pwd.h",    "sched.h",   "signal.h", "spawn.h",     "stdlib.h",    "string.h",
      "syslog.h",  "time.h",   "termios.h", "unistd.h", "semaphore.h", "endian.h"};
  const bool standard = header.find_first_of("./") == std::string::npos;
  return standard || std::ranges::find(kFiles, header) != kFiles.end() ||
         std::ranges::any_of(kFolders, [&](auto folder) { return header.starts_with(folder); });
}

bool isPattern(const std::string& folder) {
  return folder.ends_with("/*");
}

bool begins(const std::string& folder, const std::string& path) {
  if (isPattern(folder)) {
    const std::string above = folder.substr(0, folder.size() - 1);
    return path.starts_with(above) && path.find('/', above.size()) != std::string::npos;
  }
  return path == folder || path.starts_with(folder + "/");
}

/// A header with a row of its own that lies in @p folder.
bool isOwnFile(const std::string& folder, const std::string& row) {
  return row.ends_with(".h") && begins(folder, row);
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::ranges::any_of(words, [&](const auto& w) { return w == "*" || w == word; });
}

}  // namespace

LayerTable LayerTable::fromPage(const SourceFile& page) {
  std::vector<Layer> layers;
  for (const auto& cells : markdownTable(page, "Folder")) {
    if (cells.size() < 3) continue;
    for (const auto& folder : quotedWords(cells[0])) {
      layers.push_back({.folder = folder,
                        .may_include = quotedWords(cells[1]),
                        .libraries = quotedWords(cells[2])});
    }
  }
  return LayerTable(std::move(layers));
}

std::string LayerTable::placeOf(const Layer& layer, const std::string& path) {
  if (!isPattern(layer.folder)) return layer.folder;
  return path.substr(0, path.find('/', layer.folder.size() - 1));
}

const Layer* LayerTable::layerOf(const std::string& path) const {
  const Layer* best = nullptr;
  for (const auto& layer : layers_) {
    if (begins(layer.folder, path) && (!best || layer.folder.size() > best->folder.size())) {
      best = &layer;
    }
  }
  return best;
}

std::vector<std::string> LayerTable::violations(const SourceFile& file) const {
  std::vector<std::string> found;
  const Layer* own = layerOf(file.path);
  if (!own) return {file.path + ": no row of the layer table covers this file"};
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    const auto include = includeOf(file.lines[i]);
    if (!include) continue;
    const auto at = file.path + ":" + std::to_string(i + 1) + ": ";
    if (include->angle) {
      const auto library = include->header.substr(0, include->header.find('/'));
      if (!isSystemHeader(include->header) && !contains(own->libraries, library)) {
        found.push_back(at + own->folder + " may not use the library of <" + include->header + ">");
      }
      continue;
    }
    const Layer* other = layerOf(include->header);
    if (!other) {
      found.push_back(at + "\"" + include->header + "\" is not written from the root");
      continue;
    }
    const std::string here = placeOf(*own, file.path);
    const std::string there = placeOf(*other, include->header);
    if (there != here && !isOwnFile(here, there) && !contains(own->may_include, other->folder)) {
      found.push_back(at + here + " may not include " + there + " (" + include->header + ")");
    }
  }
  return found;
}

}  // namespace lint
