#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/lint/source_tree.h"
#include "tests/support/temporary_folder.h"

namespace {

class ReadTree : public testing::Test {
 protected:
  ReadTree() {
    write("ours.md", "ours");
    write("notes.md", "a contributor's own");
    write("picture.png", "");
    std::filesystem::create_directory(folder_ / "build");
    write("build/log.md", "made");
  }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text << "\n";
  }
  [[nodiscard]] bool git(const std::string& arguments) {
    const std::string command = "git -C '" + folder_.path().string() + "' " + arguments;
    return std::system((command + " >/dev/null 2>&1").c_str()) == 0;
  }
  [[nodiscard]] std::vector<std::string> paths() {
    std::vector<std::string> paths;
    for (const auto& file : lint::readTree(folder_.path())) paths.push_back(file.path);
    return paths;
  }

  test::TemporaryFolder folder_;
};

TEST_F(ReadTree, TakesOnlyWhatGitTracks) {
  if (!git("init")) GTEST_SKIP() << "git is not installed";
  ASSERT_TRUE(git("add ours.md picture.png"));
  EXPECT_THAT(paths(), testing::ElementsAre("ours.md"));
}

TEST_F(ReadTree, TakesAllButOutputsWithoutGit) {
  EXPECT_THAT(paths(), testing::ElementsAre("notes.md", "ours.md"));
}

}  // namespace
