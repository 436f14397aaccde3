#include "tests/lint/source_tree.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string_view>

namespace lint {
namespace {

namespace fs = std::filesystem;

/// Pictures, films and the like are no text.
bool isText(const fs::path& path) {
  static constexpr std::array<std::string_view, 5> kBinary = {".png", ".jpg", ".mp4", ".bin",
                                                              ".gz"};
  return std::ranges::find(kBinary, path.extension().string()) == kBinary.end();
}

/// Outputs lie beside the sources: no person wrote what is in them.
bool isOutput(const fs::path& relative) {
  const auto top = relative.begin()->string();
  return top == "build" || top == "out" || top == ".git" || top == ".cache";
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  const auto last = text.find_last_not_of(" \t\r");
  return std::string(text.substr(first, last - first + 1));
}

/// "| a | b |" -> {"a", "b"}; empty for a line that is no table row.
std::vector<std::string> cellsOf(const std::string& line) {
  const auto row = trimmed(line);
  if (row.size() < 2 || row.front() != '|' || row.back() != '|') return {};
  std::vector<std::string> cells;
  std::istringstream rest(row.substr(1));
  for (std::string cell; std::getline(rest, cell, '|');) cells.push_back(trimmed(cell));
  return cells;
}

/// What git keeps of this tree: a contributor's own files beside it are none of ours. Nothing where
/// there is no git or the tree is none of its work trees, an unpacked archive for instance.
std::vector<std::string> trackedFiles(const fs::path& root) {
  const std::string command =
      "git -c safe.directory=* -C '" + root.string() + "' ls-files --cached -z 2>/dev/null";
  std::vector<std::string> paths;
  std::FILE* pipe = fs::exists(root / ".git") ? ::popen(command.c_str(), "re") : nullptr;
  if (pipe == nullptr) return paths;
  std::string path;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    if (c != 0) {
      path.push_back(static_cast<char>(c));
    } else {
      if (fs::is_regular_file(root / path) && isText(path)) paths.push_back(path);
      path.clear();
    }
  }
  if (::pclose(pipe) != 0) paths.clear();
  std::ranges::sort(paths);
  return paths;
}

std::vector<std::string> allFiles(const fs::path& root) {
  std::vector<std::string> paths;
  for (fs::recursive_directory_iterator it(root), end; it != end; ++it) {
    const auto relative = fs::relative(it->path(), root);
    if (isOutput(relative)) {
      it.disable_recursion_pending();
    } else if (it->is_regular_file() && isText(relative)) {
      paths.push_back(relative.generic_string());
    }
  }
  std::ranges::sort(paths);
  return paths;
}

}  // namespace

fs::path root() {
  return fs::path(KAGAMI_SOURCE_DIR);
}

SourceFile read(const fs::path& root, const std::string& path) {
  SourceFile file{.path = path, .lines = {}};
  std::ifstream in(root / path);
  for (std::string line; std::getline(in, line);) file.lines.push_back(line);
  return file;
}

std::vector<SourceFile> readTree(const fs::path& root) {
  std::vector<std::string> paths = trackedFiles(root);
  if (paths.empty()) paths = allFiles(root);
  std::vector<SourceFile> files;
  files.reserve(paths.size());
  for (const auto& path : paths) files.push_back(read(root, path));
  return files;
}

std::vector<SourceFile> cppFilesOf(const std::vector<SourceFile>& files) {
  std::vector<SourceFile> cpp;
  std::ranges::copy_if(files, std::back_inserter(cpp), [](const SourceFile& file) {
    return file.path.ends_with(".h") || file.path.ends_with(".cpp");
  });
  return cpp;
}

std::vector<std::vector<std::string>> markdownTable(const SourceFile& page,
                                                    const std::string& first_heading) {
  std::vector<std::vector<std::string>> rows;
  bool inside = false;
  for (const auto& line : page.lines) {
    auto cells = cellsOf(line);
    if (!inside) {
      inside = !cells.empty() && cells.front() == first_heading;
    } else if (cells.empty()) {
      break;
    } else if (cells.front().find_first_not_of("-:") != std::string::npos) {
      rows.push_back(std::move(cells));
    }
  }
  return rows;
}

std::vector<std::string> quotedWords(const std::string& cell) {
  std::vector<std::string> words;
  for (auto open = cell.find('`'); open != std::string::npos;) {
    const auto close = cell.find('`', open + 1);
    if (close == std::string::npos) break;
    words.push_back(cell.substr(open + 1, close - open - 1));
    open = cell.find('`', close + 1);
  }
  return words;
}

}  // namespace lint
