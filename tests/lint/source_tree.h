#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lint {

struct SourceFile {
  std::string path;  ///< from the repository's root, with '/'
  std::vector<std::string> lines;
};

/// The repository's root, as configured.
[[nodiscard]] std::filesystem::path root();

[[nodiscard]] SourceFile read(const std::filesystem::path& root, const std::string& path);

/// Every text file that belongs to the project, sorted by path: those that git tracks, or without
/// git all but build outputs. Pictures are left out.
[[nodiscard]] std::vector<SourceFile> readTree(const std::filesystem::path& root);

/// The .h and .cpp files among @p files.
[[nodiscard]] std::vector<SourceFile> cppFilesOf(const std::vector<SourceFile>& files);

/// The cells of the first table in a markdown page whose first heading cell is @p first_heading,
/// without heading and rule; empty when there is no such table.
[[nodiscard]] std::vector<std::vector<std::string>> markdownTable(const SourceFile& page,
                                                                  const std::string& first_heading);

/// The words that stand in `backquotes` in one cell.
[[nodiscard]] std::vector<std::string> quotedWords(const std::string& cell);

}  // namespace lint
