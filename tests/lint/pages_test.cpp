#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/lint/source_tree.h"

namespace {

namespace fs = std::filesystem;
using lint::SourceFile;

bool isPage(const SourceFile& file) {
  return file.path.ends_with(".md");
}

constexpr std::string_view kWordLetters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";

/// The quoted words of a page that begin with a folder of ours, without those that stand for many
/// (`tests/bench/NAME_bench.cpp`, `hal/<name>/`, `tests/*`).
std::vector<std::string> pathsIn(const SourceFile& page, const std::set<std::string>& folders) {
  const std::string letters = std::string(kWordLetters) + "./";
  std::vector<std::string> paths;
  for (const std::string& line : page.lines) {
    for (const std::string& quoted : lint::quotedWords(line)) {
      const auto slash = quoted.find('/');
      if (slash == std::string::npos || !folders.contains(quoted.substr(0, slash))) continue;
      const bool one_path = quoted.find_first_not_of(letters) == std::string::npos;
      if (one_path && quoted.find("NAME") == std::string::npos) paths.push_back(quoted);
    }
  }
  return paths;
}

std::set<std::string> optionsIn(const SourceFile& file) {
  std::set<std::string> options;
  for (const std::string& line : file.lines) {
    for (auto at = line.find("--"); at != std::string::npos;) {
      const auto end = std::min(line.find_first_not_of(kWordLetters, at), line.size());
      const bool begins = at == 0 || kWordLetters.find(line[at - 1]) == std::string_view::npos;
      if (begins && end > at + 2 && line[at + 2] >= 'a' && line[at + 2] <= 'z')
        options.insert(line.substr(at, end - at));
      at = line.find("--", end);
    }
  }
  return options;
}

TEST(Pages, NamePathsInQuotes) {
  EXPECT_THAT(
      pathsIn({.path = "a.md",
               .lines = {"`rt/ring.h` `hal/` and/or `tests/NAME_test.cpp` `usr/b` hal/no.h"}},
              {"rt", "hal", "tests"}),
      testing::ElementsAre("rt/ring.h", "hal/"));
}

TEST(Pages, NameOptionsAnywhere) {
  EXPECT_THAT(optionsIn({.path = "a.md", .lines = {"run --a-b 7 (`--c`), not x--d or ---"}}),
              testing::ElementsAre("--a-b", "--c"));
}

class TreePages : public testing::Test {
 protected:
  const std::vector<SourceFile> files_ = lint::readTree(lint::root());
};

TEST_F(TreePages, NameOnlyFilesThatThereAre) {
  std::set<std::string> folders;
  for (const SourceFile& file : files_) {
    if (file.path.contains('/')) folders.insert(file.path.substr(0, file.path.find('/')));
  }
  std::size_t paths = 0;
  for (const SourceFile& file : files_) {
    if (!isPage(file)) continue;
    for (const std::string& path : pathsIn(file, folders)) {
      ++paths;
      EXPECT_TRUE(fs::exists(lint::root() / path)) << file.path << " names " << path;
    }
  }
  EXPECT_GT(paths, 20u);
}

/// An option is known when something other than a page has it.
TEST_F(TreePages, NameOnlyOptionsThatThereAre) {
  std::set<std::string> known;
  for (const SourceFile& file : files_) {
    if (!isPage(file)) known.merge(optionsIn(file));
  }
  for (const SourceFile& file : files_) {
    if (!isPage(file)) continue;
    for (const std::string& option : optionsIn(file))
      EXPECT_TRUE(known.contains(option)) << file.path << " names " << option;
  }
}

TEST_F(TreePages, TellWhatEveryFolderIsFor) {
  const SourceFile page = lint::read(lint::root(), "docs/architecture.md");
  std::set<std::string> named;
  for (const auto& row : lint::markdownTable(page, "Where")) {
    for (const std::string& folder : lint::quotedWords(row.front())) named.insert(folder);
  }
  for (const SourceFile& file : files_) {
    if (!file.path.ends_with("/CMakeLists.txt")) continue;
    const std::string folder = file.path.substr(0, file.path.rfind('/') + 1);
    if (folder.starts_with("tests/")) continue;  // HACKING.md lists the tiers
    EXPECT_TRUE(named.contains(folder)) << folder << " is not in the folders of " << page.path;
  }
}

}  // namespace
