#include "appliance/trace/trace_writer.h"

#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/trace/trace_file.h"
#include "tests/support/becomes_true.h"

namespace {

using appliance::FrameRecord;
using appliance::SetRecord;
using appliance::SummaryRecord;
using appliance::TraceWriter;
using testing::HasSubstr;

std::string temporaryFile(const std::string& name) {
  return (std::filesystem::path(testing::TempDir()) / (name + std::to_string(getpid()))).string();
}

TEST(TraceWriter, WritesWhatManyThreadsRecordOrCountsWhatItLost) {
  constexpr std::uint32_t kProducers = 6;
  constexpr std::uint64_t kRecords = 5000;
  const std::string path = temporaryFile("trace");
  auto writer = TraceWriter::open(path);
  ASSERT_TRUE(writer.has_value()) << writer.error();
  std::vector<appliance::TraceProducer*> producers;
  for (std::uint32_t camera = 0; camera < kProducers; ++camera)
    producers.push_back(&(*writer)->addProducer("camera " + std::to_string(camera + 1)));
  (*writer)->begin({.cameras = kProducers});
  {
    std::vector<std::jthread> threads;
    for (std::uint32_t camera = 0; camera < kProducers; ++camera)
      threads.emplace_back([&, camera] {
        for (std::uint64_t id = 1; id <= kRecords; ++id) {
          producers[camera]->record(FrameRecord{.camera = camera, .frame_id = id});
          if (id % 128 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
      });
  }
  SummaryRecord summary;
  summary.clean_stop = true;
  const auto finished = (*writer)->finish(summary);
  ASSERT_TRUE(finished.has_value()) << finished.error();

  const auto trace = appliance::readTraceFile(path);
  ASSERT_TRUE(trace.has_value()) << trace.error();
  ASSERT_TRUE(trace->summary.has_value());
  EXPECT_EQ(trace->frames.size() + trace->summary->trace_dropped, kProducers * kRecords);
  std::vector<std::uint64_t> last(kProducers);
  for (const FrameRecord& frame : trace->frames) {
    EXPECT_GT(frame.frame_id, last[frame.camera]);  // each thread's records stay in order
    last[frame.camera] = frame.frame_id;
  }
  std::filesystem::remove(path);
}

TEST(TraceWriter, CountsWhatFindsAFullRing) {
  const std::string path = temporaryFile("full");
  auto writer = TraceWriter::open(path);
  ASSERT_TRUE(writer.has_value()) << writer.error();
  // Rings are drained from begin() on.
  appliance::TraceProducer& producer = (*writer)->addProducer("one");
  for (std::uint64_t i = 1; i <= 1000; ++i) producer.record(SetRecord{i, {}});
  const std::uint64_t lost = (*writer)->dropped();
  EXPECT_GT(lost, 0u);
  (*writer)->begin({});
  ASSERT_TRUE((*writer)->finish({}).has_value());
  const auto trace = appliance::readTraceFile(path);
  ASSERT_TRUE(trace.has_value()) << trace.error();
  EXPECT_EQ(trace->sets.size(), 1000 - lost);
  EXPECT_EQ(trace->sets.back().trigger, 1000 - lost);  // the newest were refused
  EXPECT_EQ(trace->summary->trace_dropped, lost);
  std::filesystem::remove(path);
}

TEST(TraceWriter, SaysThatAFileCannotBeMade) {
  const auto writer = TraceWriter::open("/nonexistent/folder/trace.jsonl");
  ASSERT_FALSE(writer.has_value());
  EXPECT_THAT(writer.error(), HasSubstr("cannot write the trace /nonexistent/folder/trace.jsonl"));
}

TEST(TraceWriter, SaysAFullDiskWhileItRunsAndAgainAtTheEnd) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  auto writer = TraceWriter::open("/dev/full");
  ASSERT_TRUE(writer.has_value()) << writer.error();
  appliance::TraceProducer& producer = (*writer)->addProducer("one");
  (*writer)->begin({});
  for (std::uint64_t i = 1; i <= 500; ++i) producer.record(SetRecord{i, {}});
  EXPECT_TRUE(test::becomesTrue([&] { return !(*writer)->failure().empty(); }));
  EXPECT_THAT((*writer)->failure(), HasSubstr("No space left"));
  const auto finished = (*writer)->finish({});
  ASSERT_FALSE(finished.has_value());
  EXPECT_THAT(finished.error(), HasSubstr("No space left"));
}

}  // namespace
