#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/box/part_list.h"

namespace {

using namespace std::chrono_literals;
using appliance::Answer;
using appliance::Part;
using appliance::PartList;
using appliance::Request;
using appliance::Status;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Log = std::vector<std::string>;

/// Notes what happens to it.
class NotingPart : public Part {
 public:
  NotingPart(std::string name, Log& log) : name_(std::move(name)), log_(log) {}
  ~NotingPart() override { log_.push_back("destroy " + name_); }

  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] std::expected<void, std::string> start() override {
    log_.push_back("start " + name_);
    return {};
  }
  void stop() override { log_.push_back("stop " + name_); }
  void report(Status& status) const override {
    status.sections.push_back({.key = name_, .line = "fine"});
  }
  [[nodiscard]] Answer handle(const Request& request) override {
    if (request.verb != name_ + ".mark") return std::nullopt;
    log_.push_back(request.verb + " " + request.argument);
    return std::expected<void, std::string>{};
  }

 private:
  const std::string name_;
  Log& log_;
};

class FailingPart final : public NotingPart {
 public:
  using NotingPart::NotingPart;
  [[nodiscard]] std::expected<void, std::string> start() override {
    (void)NotingPart::start();
    return std::unexpected("the lamp is broken: replace it");
  }
};

/// Stops only when the test lets it.
class HangingPart final : public NotingPart {
 public:
  HangingPart(std::string name, Log& log, std::shared_future<void> release)
      : NotingPart(std::move(name), log), release_(std::move(release)) {}
  void stop() override { release_.wait(); }

 private:
  const std::shared_future<void> release_;
};

TEST(PartList, StartsInOrderAndStopsAndDestroysInReverse) {
  Log log;
  {
    PartList parts;
    parts.add(std::make_unique<NotingPart>("a", log));
    parts.add(std::make_unique<NotingPart>("b", log));
    parts.add(std::make_unique<NotingPart>("c", log));
    ASSERT_TRUE(parts.start().has_value());
    EXPECT_THAT(parts.stop(), IsEmpty());
    EXPECT_THAT(parts.stop(), IsEmpty()) << "a second stop finds nothing to do";
  }
  EXPECT_THAT(log, ElementsAre("start a", "start b", "start c", "stop c", "stop b", "stop a",
                               "destroy c", "destroy b", "destroy a"));
}

TEST(PartList, StopsWhatItDestroysIfNobodyDid) {
  Log log;
  {
    PartList parts;
    parts.add(std::make_unique<NotingPart>("a", log));
    ASSERT_TRUE(parts.start().has_value());
  }
  EXPECT_THAT(log, ElementsAre("start a", "stop a", "destroy a"));
}

TEST(PartList, StopsTheEarlierPartsIfOneDoesNotStartAndSaysWhy) {
  Log log;
  PartList parts;
  parts.add(std::make_unique<NotingPart>("a", log));
  parts.add(std::make_unique<FailingPart>("b", log));
  parts.add(std::make_unique<NotingPart>("c", log));
  const auto started = parts.start();
  ASSERT_FALSE(started.has_value());
  EXPECT_EQ(started.error(), "the lamp is broken: replace it");
  EXPECT_THAT(log, ElementsAre("start a", "start b", "stop c", "stop b", "stop a"));
  EXPECT_FALSE(parts.hung());
}

TEST(PartList, StopsTheOthersAndNamesThePartThatHangs) {
  Log log;
  std::promise<void> release;
  {
    PartList parts(50ms);
    parts.add(std::make_unique<NotingPart>("a", log));
    parts.add(std::make_unique<HangingPart>("stuck", log, release.get_future().share()));
    parts.add(std::make_unique<NotingPart>("c", log));
    ASSERT_TRUE(parts.start().has_value());
    EXPECT_THAT(parts.stop(), ElementsAre("[part-hangs] part stuck does not stop within 0.1 s: the "
                                          "process ends without it"));
    EXPECT_TRUE(parts.hung());
  }
  EXPECT_THAT(log, ElementsAre("start a", "start stuck", "start c", "stop c", "stop a", "destroy c",
                               "destroy a"))
      << "the part that hangs is not destroyed under its thread";
  release.set_value();
}

TEST(PartList, AddsUpTheReportsInOrder) {
  Log log;
  PartList parts;
  parts.add(std::make_unique<NotingPart>("a", log));
  parts.add(std::make_unique<NotingPart>("b", log));
  Status status;
  parts.report(status);
  ASSERT_EQ(status.sections.size(), 2U);
  EXPECT_EQ(status.sections[0].key, "a");
  EXPECT_EQ(status.sections[1].key, "b");
}

TEST(PartList, GivesARequestToThePartThatKnowsIt) {
  Log log;
  PartList parts;
  parts.add(std::make_unique<NotingPart>("a", log));
  parts.add(std::make_unique<NotingPart>("b", log));
  EXPECT_TRUE(parts.handle({.verb = "b.mark", .argument = "here"}).has_value());
  EXPECT_THAT(log, ElementsAre("b.mark here"));
  const auto unknown = parts.handle({.verb = "c.mark"});
  ASSERT_FALSE(unknown.has_value());
  EXPECT_THAT(unknown.error(), HasSubstr("no part of this box knows \"c.mark\""));
}

}  // namespace
