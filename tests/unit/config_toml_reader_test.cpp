#include <cstdio>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/config/toml_reader.h"

namespace {

using appliance::closestWord;
using appliance::TomlFile;
using testing::HasSubstr;

TomlFile parsed(std::string_view text) {
  auto file = TomlFile::parse(text, "box.toml");
  EXPECT_TRUE(file.has_value()) << file.error();
  return std::move(*file);
}

/// The fault that @p read leaves behind, or "none".
template <class Read>
std::string faultOf(std::string_view text, Read read) {
  const TomlFile file = parsed(text);
  read(file.root());
  return file.fault().value_or("none");
}

TEST(TomlReader, ReadsEveryKindOfValue) {
  const TomlFile file = parsed(
      "name = \"arc\"\nrate_hz = 40\ngain = 1.5\nflag = true\nlist = [1, 2.5]\n"
      "m = [[1, 2], [3, 4]]\nwords = [\"a\", \"b\"]\n[sub]\ndepth = 7\n[[item]]\n[[item]]\n");
  const auto root = file.root();
  EXPECT_EQ(root.text("name"), "arc");
  EXPECT_EQ(root.number("rate_hz"), 40.0);
  EXPECT_EQ(root.integer("rate_hz"), 40);
  EXPECT_EQ(root.number("gain"), 1.5);
  EXPECT_TRUE(root.flagOr("flag", false));
  EXPECT_EQ(root.numbers("list", 2), (std::vector<double>{1, 2.5}));
  EXPECT_EQ(root.matrix("m", 2, 2), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(root.textsOr("words", {}), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(root.table("sub").integer("depth"), 7);
  EXPECT_EQ(root.tables("item").size(), 2u);
  EXPECT_EQ(file.fault(), std::nullopt);
}

TEST(TomlReader, GivesTheFallbackOnlyWhereTheKeyIsAbsent) {
  const TomlFile file = parsed("present = 3\n");
  const auto root = file.root();
  EXPECT_EQ(root.integerOr("present", 9), 3);
  EXPECT_EQ(root.integerOr("absent", 9), 9);
  EXPECT_EQ(root.numberOr("absent", 0.5), 0.5);
  EXPECT_EQ(root.textOr("absent", "x"), "x");
  EXPECT_EQ(root.table("absent").integerOr("deep", 4), 4);
  EXPECT_TRUE(root.tables("absent").empty());
  EXPECT_EQ(file.fault(), std::nullopt);
}

TEST(TomlReader, WarnsOfUnknownKeysAndReadsOn) {
  const TomlFile file = parsed("name = \"arc\"\nrat_hz = 40\n[sub]\nbanana = 1\n");
  const auto root = file.root();
  root.warnUnknownKeys({"name", "rate_hz", "sub"});
  root.table("sub").warnUnknownKeys({"depth"});
  EXPECT_EQ(root.text("name"), "arc");
  EXPECT_EQ(file.fault(), std::nullopt);
  EXPECT_THAT(file.warnings(),
              testing::ElementsAre(
                  "box.toml:2: unknown key \"rat_hz\"; did you mean \"rate_hz\"?",
                  "box.toml:4: [sub]: unknown key \"banana\"; it is ignored; another version may "
                  "know it"));
}

TEST(TomlReader, KeepsNoMoreWarningsThanAJournalCanBear) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "key" + std::to_string(i) + " = 1\n";
  const TomlFile file = parsed(text);
  file.root().warnUnknownKeys({"name"});
  EXPECT_EQ(file.warnings().size(), 32u);
}

TEST(TomlReader, NamesFileLineAndMissingKey) {
  EXPECT_EQ(faultOf("\n[sub]\n", [](auto root) { (void)root.table("sub").number("rate_hz"); }),
            "box.toml:2: [sub]: the key \"rate_hz\" is missing; add it");
}

TEST(TomlReader, SuggestsTheClosestKeyForAnUnknownOne) {
  EXPECT_EQ(faultOf("name = 1\nrat_hz = 3\n",
                    [](auto root) { root.allowKeys({"name", "rate_hz", "period_ms"}); }),
            "box.toml:2: unknown key \"rat_hz\"; did you mean \"rate_hz\"?");
}

TEST(TomlReader, SuggestsNothingFarFetched) {
  const auto fault = faultOf("banana = 3\n", [](auto root) { root.allowKeys({"rate_hz"}); });
  EXPECT_THAT(fault, HasSubstr("box.toml:1: unknown key \"banana\"; remove it"));
}

TEST(TomlReader, SaysWhatWasExpectedAndWhatStandsThere) {
  const auto wrong = [](const char* text) {
    return faultOf(text, [](auto root) { (void)root.number("rate_hz", {1, 100, "Hz"}); });
  };
  EXPECT_EQ(wrong("rate_hz = \"fast\""), "box.toml:1: rate_hz must be a number in Hz, not text");
  EXPECT_EQ(wrong("rate_hz = 0.5"), "box.toml:1: rate_hz must be from 1 to 100 Hz, not 0.5");
  EXPECT_EQ(wrong("rate_hz = nan"), "box.toml:1: rate_hz must be a finite number, not nan");
  EXPECT_EQ(wrong("rate_hz = inf"), "box.toml:1: rate_hz must be a finite number, not inf");
}

TEST(TomlReader, RefusesFractionsWhereWholeNumbersAreMeant) {
  EXPECT_EQ(faultOf("n = 1.5", [](auto root) { (void)root.integer("n", {0, 9, "px"}); }),
            "box.toml:1: n must be a whole number in px, not the number 1.5");
  EXPECT_EQ(faultOf("n = 10", [](auto root) { (void)root.integer("n", {0, 9, "px"}); }),
            "box.toml:1: n must be from 0 to 9 px, not 10");
}

TEST(TomlReader, RefusesArraysOfAnotherLengthAndNamesTheElementThatIsWrong) {
  const auto three = [](auto root) { (void)root.numbers("v", 3); };
  EXPECT_EQ(faultOf("v = [1, 2]", three),
            "box.toml:1: v must be an array of 3 numbers, not an array of 2");
  EXPECT_EQ(faultOf("v = [1, 2,\n\"x\"]", three), "box.toml:2: v[2] must be a number, not text");
  EXPECT_EQ(faultOf("m = [[1, 2], [3]]", [](auto root) { (void)root.matrix("m", 2, 2); }),
            "box.toml:1: m[1] must be an array of 2 numbers, not an array of 1");
}

TEST(TomlReader, KeepsTheFirstFaultBecauseLaterOnesMayFollowFromIt) {
  EXPECT_EQ(faultOf("",
                    [](auto root) {
                      (void)root.text("first");
                      (void)root.text("second");
                    }),
            "box.toml:1: the key \"first\" is missing; add it");
}

TEST(TomlReader, NamesTheLineOfASyntaxError) {
  const auto file = TomlFile::parse("a = 1\nb = = 2\n", "box.toml");
  ASSERT_FALSE(file.has_value());
  EXPECT_THAT(file.error(), HasSubstr("box.toml:2: not valid TOML: "));
  EXPECT_EQ(file.error().find('\n'), std::string::npos);
}

TEST(TomlReader, SaysThatAFileIsMissingOrNotAFile) {
  const auto missing = TomlFile::load("/nonexistent/box.toml");
  ASSERT_FALSE(missing.has_value());
  EXPECT_THAT(missing.error(), HasSubstr("/nonexistent/box.toml: cannot be opened"));
  const auto folder = TomlFile::load("/tmp");
  ASSERT_FALSE(folder.has_value());
  EXPECT_THAT(folder.error(), HasSubstr("/tmp: is a folder"));
  const auto endless = TomlFile::load("/dev/zero");
  ASSERT_FALSE(endless.has_value());
  EXPECT_THAT(endless.error(), HasSubstr("/dev/zero: is larger than 4 MiB"));
}

TEST(ClosestWord, PrefersTheSmallestEditDistance) {
  const std::array<std::string_view, 3> known = {"view-left", "view-right", "sweep"};
  EXPECT_EQ(closestWord("view-rigth", known), "view-right");
  EXPECT_EQ(closestWord("sweeps", known), "sweep");
  EXPECT_EQ(closestWord("q", known), std::nullopt);
  EXPECT_EQ(closestWord("", known), std::nullopt);
}

}  // namespace
