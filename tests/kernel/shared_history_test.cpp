// The frame history as dma-bufs of a real kernel, and what a KMS device's renderer makes of them.

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gbm.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include "appliance/capture/frame_history.h"
#include "appliance/geometry/rig.h"
#include "appliance/render/history_views.h"
#include "appliance/render/render_loop.h"
#include "rt/clock.h"
#include "rt/unique_fd.h"
#include "ui-kms/renderer.h"

namespace {

using namespace appliance;

const HistoryLayout kOneCamera{.frame_bytes = {std::size_t{1280} * 1024}, .sets = 300};

std::unique_ptr<FrameHistory> makeShared(const HistoryLayout& layout) {
  auto history = FrameHistory::create(layout, HistorySharing::kShared);
  EXPECT_TRUE(history) << history.error();
  return history ? std::move(*history) : nullptr;
}

/// The first byte of a piece of a dma-buf, as a device would read it.
int firstByte(const rt::DmaBufPart& part) {
  void* const mapped =
      mmap(nullptr, 4096, PROT_READ, MAP_SHARED, part.fd, static_cast<off_t>(part.offset_bytes));
  if (mapped == MAP_FAILED) return -1;
  const int byte = *static_cast<const unsigned char*>(mapped);
  munmap(mapped, 4096);
  return byte;
}

TEST(SharedHistory, ARingOf300FramesIsAFewDmaBufsWithEveryFrameInItsPlace) {
  const rt::Timestamp begin = rt::now();
  const auto history = makeShared(kOneCamera);
  const std::chrono::duration<double, std::milli> shared_ms = rt::now() - begin;
  ASSERT_NE(history, nullptr);
  ASSERT_EQ(history->notShared(), "");
  const auto plain_begin = rt::now();
  ASSERT_TRUE(FrameHistory::create(kOneCamera));
  const std::chrono::duration<double, std::milli> plain_ms = rt::now() - plain_begin;
  std::printf("history of one camera: %.0f ms shared, %.0f ms private\n", shared_ms.count(),
              plain_ms.count());

  CameraFrames& frames = history->camera(0);
  std::vector<std::uint32_t> queue(frames.fillingSlots().begin(), frames.fillingSlots().end());
  for (std::uint64_t trigger = 1; trigger <= 320; ++trigger) {
    const std::uint32_t slot = queue.front();
    queue.erase(queue.begin());
    frames.slots()[slot].front() = static_cast<std::byte>(trigger);
    queue.push_back(frames.store(slot, {.trigger = trigger}));
  }
  FrameReader& reader = **history->openReader("test", 1);
  std::set<std::uint64_t> buffers;
  for (std::uint64_t trigger = 21; trigger <= 320; ++trigger) {
    const auto frame = reader.tryPin(0, trigger);
    ASSERT_TRUE(frame) << trigger;
    EXPECT_EQ(firstByte(frame->dma_buf), static_cast<int>(trigger & 0xFF)) << trigger;
    buffers.insert(frame->dma_buf.buffer);
  }
  EXPECT_LE(buffers.size(), 7U);  // 48 frames fit into 64 MiB
}

/// At most @p more files than are open now, until the end of the scope.
class FewerFiles {
 public:
  explicit FewerFiles(rlim_t more) {
    getrlimit(RLIMIT_NOFILE, &before_);
    const rt::UniqueFd next(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    const rlimit few{.rlim_cur = static_cast<rlim_t>(next.get()) + more,
                     .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_NOFILE, &few);
  }
  ~FewerFiles() { setrlimit(RLIMIT_NOFILE, &before_); }
  FewerFiles(const FewerFiles&) = delete;
  FewerFiles& operator=(const FewerFiles&) = delete;

 private:
  rlimit before_{};
};

TEST(SharedHistory, OutOfFileDescriptorsItServesUnsharedAndSaysWhatToRaise) {
  const FewerFiles few(4);
  const auto history = makeShared(kOneCamera);
  ASSERT_NE(history, nullptr);
  EXPECT_NE(history->notShared().find("raise LimitNOFILE"), std::string::npos)
      << history->notShared();
  CameraFrames& frames = history->camera(0);
  (void)frames.store(frames.fillingSlots()[0], {.trigger = 1});
  const auto frame = (*history->openReader("test", 1))->tryPin(0, 1);
  ASSERT_TRUE(frame);
  EXPECT_FALSE(frame->dma_buf.valid());
}

/// A screen that notes where its last frame came from.
class NotingDisplay final : public hal::Display {
 public:
  [[nodiscard]] hal::DisplayMode mode() const override { return {320, 256, 60}; }
  [[nodiscard]] std::string_view renderer() const override { return "a test"; }
  [[nodiscard]] std::string_view uploadReason() const override { return {}; }
  [[nodiscard]] hal::Typesetter* typesetter() override { return nullptr; }
  [[nodiscard]] rt::Result<hal::RenderInstants> render(const hal::Scene& scene) override {
    const hal::SourceImage& source = scene.layers[0].plan.source;
    hal::RenderInstants instants;
    instants.imported = scene.count != 0 && source.dma_buf.valid();
    if (instants.imported) first_byte_ = firstByte(source.dma_buf);
    return instants;
  }
  [[nodiscard]] rt::Result<rt::Timestamp> commit(std::uint64_t /*picture_id*/) override {
    return rt::now();
  }
  [[nodiscard]] std::optional<hal::PageFlip> tryPopFlip() override { return std::nullopt; }
  [[nodiscard]] std::optional<hal::DisplayTiming> timing() const override { return std::nullopt; }
  [[nodiscard]] std::optional<rt::Timestamp> nextCall() const override { return std::nullopt; }
  [[nodiscard]] hal::ScreenStatus screen() const override { return {}; }
  void releaseScreen() override {}
  void takeScreen() override {}
  void detach() override {}

  [[nodiscard]] int firstByteShown() const { return first_byte_; }

 private:
  std::atomic<int> first_byte_ = -1;
};

/// Counts the pictures that were reported as read in place.
class ImportCounter final : public PictureObserver {
 public:
  void onPicture(const ShownPicture& picture) noexcept override {
    if (picture.record.imported) ++imported_;
  }
  [[nodiscard]] int imported() const { return imported_; }

 private:
  std::atomic<int> imported_ = 0;
};

TEST(SharedHistory, TheRenderLoopGivesTheShownSlotToTheDisplayAndRecordsThatItWasRead) {
  Rig rig;
  rig.cameras.push_back({.name = "only",
                         .width_px = 320,
                         .height_px = 256,
                         .lens = {.fx_px = 300, .fy_px = 300, .max_radius = 1}});
  rig.cameras[0].t_cam_rig_m = {0, 0, 4};
  fillReferences(rig);
  const auto history = makeShared({.frame_bytes = {std::size_t{320} * 256},
                                   .sets = 10,
                                   .in_flight = 2,
                                   .reserve = RenderLoop::kPinsPerCamera});
  ASSERT_NE(history, nullptr);
  ASSERT_EQ(history->notShared(), "");
  CaptureBoard board(1);
  HistoryViews shown(**history->openReader("render", RenderLoop::kPinsPerCamera), board.edges);
  CommandInbox commands(board.wake_render);
  ShownBoard on_screen;
  const TargetTrack target;
  NotingDisplay display;
  OverlayBoard overlay;
  ImportCounter observer;
  RigShelf rigs(rig);
  RenderLoop loop({.rigs = rigs,
                   .frames = shown,
                   .board = board,
                   .commands = commands,
                   .shown = on_screen,
                   .target = target,
                   .display = display,
                   .overlay = overlay,
                   .trace = nullptr,
                   .observer = &observer},
                  {.trigger_period = std::chrono::milliseconds(25)});
  const std::jthread render([&loop](const std::stop_token& stop) { loop.run(stop); });

  CameraFrames& frames = history->camera(0);
  std::uint32_t slot = frames.fillingSlots()[0];
  for (const std::uint64_t trigger : {std::uint64_t{1}, std::uint64_t{2}}) {
    frames.slots()[slot].front() = static_cast<std::byte>(40 + trigger);
    board.edges.post(trigger, rt::now());
    slot = frames.store(slot, {.trigger = trigger});
    board.wake_render.ring();
  }
  const rt::Timestamp patience = rt::now() + std::chrono::seconds(20);
  while (display.firstByteShown() != 42 && rt::now() < patience) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(display.firstByteShown(), 42);
  while (observer.imported() == 0 && rt::now() < patience) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_GT(observer.imported(), 0);
}

// Drawing from what it imported would end the process.
TEST(ImportOnKms, IsNotTriedWithTheSoftwareRendererAlthoughEglListsIt) {
  const rt::UniqueFd card(::open("/dev/dri/card0", O_RDWR | O_CLOEXEC));
  ASSERT_TRUE(card.valid()) << "the test kernel's screen";
  const std::unique_ptr<gbm_device, decltype(&gbm_device_destroy)> gbm(
      gbm_create_device(card.get()), &gbm_device_destroy);
  ASSERT_NE(gbm, nullptr);
  const auto renderer = ui::Renderer::create({.width_px = 320,
                                              .height_px = 256,
                                              .sources = {{320, 256}},
                                              .gbm = gbm.get(),
                                              .demosaic = ui::DemosaicSite::kGpu});
  ASSERT_TRUE(renderer) << renderer.error();
  ASSERT_TRUE((*renderer)->context().software()) << (*renderer)->context().renderer();
  EXPECT_EQ((*renderer)->uploadReason(),
            "a software renderer on a KMS device cannot read imported memory");
}

}  // namespace
