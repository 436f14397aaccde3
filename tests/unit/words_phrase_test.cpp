#include <string>

#include <gtest/gtest.h>

#include "appliance/words/phrase.h"

namespace {

using appliance::idOf;
using appliance::Phrase;
using appliance::phrase;
using appliance::textOf;
using appliance::Word;
using appliance::words::argumentsOf;
using appliance::words::formatted;

TEST(Phrase, IsSaidWithItsArguments) {
  EXPECT_EQ(textOf(phrase<Word::kCameraSilent>(4.04)),
            "no frames for 4.0 s although it answers: check its trigger wire");
  EXPECT_EQ(textOf(phrase<Word::kCameraHeldBy>("10.0.0.9")),
            "in use by another program (10.0.0.9): close it, the camera reconnects automatically");
}

TEST(Phrase, OfNothingIsEmpty) {
  EXPECT_TRUE(Phrase().empty());
  EXPECT_EQ(textOf({}), "");
}

TEST(Phrase, ComparesByWordAndArguments) {
  EXPECT_EQ(phrase<Word::kCameraHeldBy>("a"), phrase<Word::kCameraHeldBy>(std::string("a")));
  EXPECT_NE(phrase<Word::kCameraHeldBy>("a"), phrase<Word::kCameraHeldBy>("b"));
  EXPECT_NE(phrase<Word::kCameraQuiet>(1.0), phrase<Word::kCameraGone>(1.0));
}

TEST(Phrase, HasAnIdThatNoLanguageChanges) {
  EXPECT_EQ(idOf(Word::kCameraSilent), "camera-silent");
  EXPECT_EQ(idOf(Word::kCameraHeldBy), "camera-held-by");
}

TEST(Phrase, CutsTextThatDoesNotFitBetweenTwoCharacters) {
  std::string kanji;  // three bytes each
  for (int i = 0; i < 200; ++i) kanji += "\xE9\x8F\xA1";
  const std::string text = textOf(phrase<Word::kCameraRefuses>(kanji));
  EXPECT_EQ(text, kanji.substr(0, text.size()));
  EXPECT_EQ(text.size() % 3, 0u);
  EXPECT_GT(text.size(), 390u);
}

TEST(Pattern, OfAnotherLanguageMayReorderItsPlaceholders) {
  const Phrase late = phrase<Word::kCameraSilent>(2.55);
  EXPECT_EQ(formatted("{seconds:.2} / {seconds:d} / {seconds:g}", late), "2.55 / 3 / 2.55");
  EXPECT_EQ(formatted("nothing of it", late), "nothing of it");
  EXPECT_EQ(formatted("{unknown}", late), "") << "the words' test finds such a pattern";
}

TEST(Pattern, WithAWrongBraceOrFormatIsNone) {
  for (const char* wrong : {"{", "}", "{}", "{a:}", "{a:x}", "{a:.}", "{a:.0}", "a}b", "{a:d",
                            "{a:d} {a}", "{a}{b}{c}{d}{e}{f}{g}{h}{i}"})
    EXPECT_FALSE(argumentsOf(wrong)) << wrong;
  EXPECT_EQ(argumentsOf("{a} {b:.2} {a}")->count, 2u);
}

}  // namespace
