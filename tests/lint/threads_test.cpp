#include <regex>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/lint/source_tree.h"

namespace {

using lint::SourceFile;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A family of threads has one name: `recv01`, "recv%02u" and "recv" + number are all `recv`.
std::string familyOf(const std::string& name) {
  return name.substr(0, name.find_first_of("0123456789%"));
}

/// The families in the first column of the thread table; `recvNN` is the last of its family.
std::set<std::string> namesInTable(const SourceFile& page) {
  std::set<std::string> names;
  for (const auto& cells : lint::markdownTable(page, "Thread")) {
    for (const auto& name : lint::quotedWords(cells.front())) {
      if (!name.ends_with("NN")) names.insert(familyOf(name));
    }
  }
  return names;
}

/// The families that a file gives to threads: as the name of an rt::ThreadConfig, by a function
/// that starts or names a thread, or to the kernel.
std::set<std::string> namesInCode(const SourceFile& file) {
  std::string text;
  for (const auto& line : file.lines) text += line + "\n";
  static const std::regex kConfig(
      R"re(hreadConfig\s*\w*\s*[({]\s*(?:\.name\s*=\s*)?"([a-z]+[%0-9a-z]*)")re");
  static const std::regex kStart(
      R"re(Thread::start\s*\(\s*\{\s*(?:\.name\s*=\s*)?"([a-z]+[%0-9a-z]*)")re");
  static const std::regex kHelper(R"re(hreads\.startInto\s*\([^",]*,\s*"([a-z]+[%0-9a-z]*)")re");
  static const std::regex kNumbered(R"re(ThreadName\([^"}]*\{[^"}]*"([a-z]+%[0-9a-z]*)")re");
  static const std::regex kKernel(R"re(pthread_setname_np\s*\([^;"]*"([a-z]+[%0-9a-z]*)")re");
  std::set<std::string> names;
  for (const auto* pattern : {&kConfig, &kStart, &kHelper, &kNumbered, &kKernel}) {
    for (std::sregex_iterator it(text.begin(), text.end(), *pattern), end; it != end; ++it) {
      names.insert(familyOf((*it)[1]));
    }
  }
  return names;
}

/// The daemon's sources: the emulator is another program, and tests name what they like.
bool isOfTheDaemon(const SourceFile& file) {
  return !file.path.starts_with("tests/") && !file.path.starts_with("hal/emulated/rig/");
}

TEST(ThreadNames, AreReadFromTheTable) {
  EXPECT_THAT(namesInTable({.path = "page.md",
                            .lines = {"| Thread | Scheduler |", "|---|---|", "| `trigger` | FIFO |",
                                      "| `recv01`..`recvNN` | FIFO |"}}),
              ElementsAre("recv", "trigger"));
}

TEST(ThreadNames, AreReadFromTheCode) {
  EXPECT_THAT(
      namesInCode({.path = "a.cpp",
                   .lines = {"const rt::ThreadConfig config{.name = \"trigger\",",
                             "auto t = rt::Thread::start({.name = \"render\", .priority = 60}, f);",
                             "return shared_.threads.startInto(thread_, \"panel\", how, body);",
                             "std::string receiveThreadName(std::size_t camera) {",
                             "  std::snprintf(name, sizeof name, \"recv%02zu\", camera);",
                             "pthread_setname_np(pthread_self(), \"trace\");"}}),
      ElementsAre("panel", "recv", "render", "trace", "trigger"));
  EXPECT_THAT(namesInCode({.path = "a.cpp",
                           .lines = {"void open(const rt::ThreadConfig& receive) {",
                                     "  if (backend == \"aravis\") camera.name = \"left\";"}}),
              IsEmpty());
}

TEST(Tree, NamesItsThreadsAsTheThreadTableDoes) {
  const auto table = namesInTable(lint::read(lint::root(), "docs/real-time.md"));
  ASSERT_FALSE(table.empty()) << "the thread table is missing from docs/real-time.md";
  std::set<std::string> code = {"main"};  // named by the kernel, after the program
  for (const auto& file : lint::cppFilesOf(lint::readTree(lint::root()))) {
    if (!isOfTheDaemon(file)) continue;
    for (const auto& name : namesInCode(file)) {
      code.insert(name);
      EXPECT_TRUE(table.contains(name))
          << file.path << " names a thread '" << name << "' that docs/real-time.md does not list";
    }
  }
  for (const auto& name : table) {
    EXPECT_TRUE(code.contains(name))
        << "docs/real-time.md lists '" << name << "', a name that no code gives to a thread";
  }
}

}  // namespace
