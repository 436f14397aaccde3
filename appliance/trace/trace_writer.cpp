#include "appliance/trace/trace_writer.h"

#include <cassert>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include <pthread.h>

#include "appliance/trace/trace_file.h"
#include "appliance/words/phrase.h"

namespace appliance {
namespace {

constexpr std::chrono::milliseconds kDrainEvery{100};  // a twentieth of what a ring holds

std::string describe(const std::string& path, int error) {
  return withId(phrase<Word::kTraceFile>(path, std::strerror(error)));
}

}  // namespace

std::expected<std::unique_ptr<TraceWriter>, std::string> TraceWriter::open(
    const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "we");
  if (file == nullptr) return std::unexpected(describe(path, errno));
  return std::unique_ptr<TraceWriter>(new TraceWriter(path, file));
}

void TraceWriter::begin(const RunRecord& run) {
  write(toLine(run));
  thread_ = std::jthread([this](const std::stop_token& stop) { this->run(stop); });
}

TraceProducer& TraceWriter::addProducer(std::string name) {
  assert(!thread_.joinable());
  producers_.push_back(std::make_unique<TraceProducer>(std::move(name)));
  return *producers_.back();
}

TraceWriter::TraceWriter(std::string path, std::FILE* file) : path_(std::move(path)), file_(file) {}

std::uint64_t TraceWriter::dropped() const {
  std::uint64_t sum = 0;
  for (const auto& producer : producers_) sum += producer->dropped();
  return sum;
}

std::string TraceWriter::failure() const {
  const int error = write_errno_.load();
  return error == 0 ? std::string() : std::strerror(error);
}

std::expected<void, std::string> TraceWriter::finish(const SummaryRecord& summary) {
  thread_ = std::jthread();  // asks it to stop and joins: from here the rings are ours
  drain();
  SummaryRecord complete = summary;
  complete.trace_dropped = dropped();
  write(toLine(complete));
  flush();
  file_.reset();
  if (write_errno_ != 0) return std::unexpected(describe(path_, write_errno_));
  return {};
}

void TraceWriter::run(const std::stop_token& stop) {
  (void)pthread_setname_np(pthread_self(), "trace");
  while (!stop.stop_requested()) {
    drain();
    flush();  // so that a full disk is noticed, and a power cut costs little
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, stop, kDrainEvery, [] { return false; });
  }
}

void TraceWriter::drain() {
  std::string text;
  for (const auto& producer : producers_)
    while (const auto record = producer->ring_.tryPop()) appendLine(text, *record);
  write(text);
}

void TraceWriter::write(const std::string& text) {
  if (write_errno_ != 0 || text.empty()) return;
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) fail();
}

void TraceWriter::flush() {
  if (write_errno_ == 0 && std::fflush(file_.get()) != 0) fail();
}

void TraceWriter::fail() {
  write_errno_ = errno != 0 ? errno : EIO;
}

}  // namespace appliance
