#include "appliance/config/text_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace appliance {

std::expected<std::string, std::string> readTextFile(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in)
    return std::unexpected(path + ": cannot be opened (" + std::strerror(errno) +
                           "); check the path and its permissions");
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    return std::unexpected(path + ": is a folder; name the file in it");
  std::string text(kLargestTextFile + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) return std::unexpected(path + ": cannot be read (" + std::strerror(errno) + ")");
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kLargestTextFile)
    return std::unexpected(path + ": is larger than " + std::to_string(kLargestTextFile >> 20U) +
                           " MiB: name another file");
  return text;
}

}  // namespace appliance
