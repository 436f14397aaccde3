#include "hal/emulated/studio/play.h"

#include <algorithm>
#include <barrier>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <optional>
#include <thread>

#include <sched.h>

#include "hal/emulated/studio/covers.h"
#include "hal/emulated/studio/hall.h"
#include "hal/emulated/studio/hall_renderer.h"
#include "hal/emulated/studio/moment_file.h"
#include "hal/emulated/studio/moment_store.h"
#include "hal/emulated/studio/people_renderer.h"
#include "hal/emulated/studio/rgbd_track.h"
#include "hal/emulated/studio/scene_cache.h"
#include "hal/emulated/studio/sensor_view.h"
#include "hal/emulated/studio/studio_gl.h"
#include "hal/emulated/studio/world.h"
#include "rt/memory.h"

namespace emulator::studio {
namespace {

/// Raise this whenever pictures of the same seed change: caches of another number are not used.
constexpr int kPictures = 6;
constexpr std::uint32_t kBlock = MomentStore::kBlock;  ///< moments in one file of the cache
static_assert(kBlock % kVariants == 0);                ///< a play ends with a round of variants
constexpr unsigned kMostThreads = 8;
constexpr std::uint64_t kUsualMomentBytes = 160'000;  // per camera

constexpr rt::Nanoseconds kRest = std::chrono::seconds(1);

using Clock = std::chrono::steady_clock;

/// The calling thread runs only when no other thread wants the processor.
void yieldToOthers() {
  const sched_param none{};
  ::sched_setscheduler(0, SCHED_IDLE, &none);
}

std::string fileOfBlock(std::uint32_t block) {
  return "moments-" + std::to_string(block);
}

}  // namespace

struct Play::State {
  State(const StudioOptions& given, Progress shown)
      : options(given),
        progress(std::move(shown)),
        rig(makeStudioRig(given.cameras, given.size, given.seed)),
        moments(given.only, static_cast<std::uint32_t>(std::lround(given.play_s * kMoments_hz)) /
                                kVariants * kVariants) {
    if (given.depth_sensor) rgbd = std::make_unique<RgbdTrack>(given.seed, moments.moments());
  }

  void loadCache();
  [[nodiscard]] bool loadBlock(std::uint32_t block);
  [[nodiscard]] bool keepsMoments() const { return options.only.empty(); }
  void prepareHall();
  void work(std::size_t worker);
  void drawBackdrops(std::size_t worker);
  void drawMoments(std::size_t worker);
  [[nodiscard]] bool drawMoment(PeopleRenderer& people, std::uint32_t turn, std::size_t worker);
  [[nodiscard]] bool mayDraw(std::size_t worker) const;
  void finish(std::uint32_t turn);
  void settle(std::uint32_t block);
  void storeBlock(std::uint32_t block);
  [[nodiscard]] bool hasHall() const {
    return std::ranges::all_of(views, [](const auto& view) { return view != nullptr; }) &&
           (!rgbd || rgbd->view() != nullptr);
  }
  [[nodiscard]] bool rests() const { return rt::now() < rt::fromNs(shown_ns.load()) + kRest; }
  void report(double share, const char* what) {
    const std::lock_guard lock(progress_mutex);
    progress(share, what);
  }

  StudioOptions options;
  Progress progress;
  std::mutex progress_mutex;
  StudioRig rig;
  SceneCache cache;
  std::string renderer;

  // What drawing needs; gone when all is drawn.
  std::vector<Surface> hall;
  std::vector<Lamp> lamps;
  CoverPictures covers;
  cv::Mat grain;
  BakedLight light;
  cv::Mat floor_light;
  std::unique_ptr<World> world;

  std::vector<std::unique_ptr<SensorView>> views;
  std::vector<std::vector<float>> depth_m;
  MomentStore moments;
  std::unique_ptr<RgbdTrack> rgbd;  // none without a depth sensor
  std::uint32_t cached = 0;         // of the first so many moments we have the cameras' pictures
  std::atomic<std::size_t> backdrops_done = 0;
  std::atomic<bool> hall_drawn = false;  // in every view
  std::atomic<bool> playing = false;
  std::atomic<std::int64_t> shown_ns = 0;  // when a camera was shown something
  std::atomic<bool> stop = false;
  unsigned thread_count = 0;
  std::uint32_t working = 0;  // guarded by mutex
  std::mutex mutex;
  std::mutex cache_mutex;
  std::condition_variable changed;
  std::optional<std::barrier<>> backdrops_drawn;
  std::vector<std::jthread> workers;
};

void Play::State::loadCache() {
  const std::uint32_t cameras = options.cameras;
  for (std::uint32_t c = 0; c < cameras; ++c) {
    const auto bytes = cache.load("camera-" + std::to_string(c));
    const std::size_t pixels = std::size_t{options.size.width} * options.size.height;
    const std::size_t view_bytes = SensorView::savedBytes(options.size);
    if (!bytes || bytes->size() != view_bytes + pixels * sizeof(float)) continue;
    views[c] = std::make_unique<SensorView>(rig.cameras[c], c, std::span(*bytes).first(view_bytes));
    depth_m[c].resize(pixels);
    std::memcpy(depth_m[c].data(), &(*bytes)[view_bytes], pixels * sizeof(float));
    report(0.5 * (c + 1) / cameras, "reading");
  }
  if (rgbd) rgbd->load(cache);
  for (std::uint32_t block = 0; keepsMoments() && loadBlock(block); ++block)
    report(0.5 + 0.5 * cached / static_cast<double>(moments.moments()), "reading");
}

/// False: it is not there, or there is no memory for it.
bool Play::State::loadBlock(std::uint32_t block) {
  const std::uint32_t first = block * kBlock;
  if (first >= moments.moments() || moments.full()) return false;
  const auto patches = moments.patchesOfBlock(block);
  const auto count = static_cast<std::uint32_t>(patches.size());
  const auto bytes = cache.load(fileOfBlock(block));
  if (!bytes) return false;
  auto loaded = readMoments(*bytes, count, options.cameras, options.size);
  if (!loaded) return false;
  std::ranges::move(*loaded, patches.begin());
  cached = first + count;
  if (rgbd) rgbd->load(cache, first, count);
  for (std::uint32_t turn = first; turn < cached; ++turn)
    if ((!rgbd || rgbd->has(turn)) && moments.finish(turn)) settle(block);
  return true;
}

void Play::State::prepareHall() {
  report(0.01, "hall");
  hall = buildHall(options.seed);
  lamps = hallLamps(options.seed);
  std::jthread dressing([this] { world = std::make_unique<World>(options.seed); });
  covers = drawCovers(options.seed);
  grain = drawFloorGrain(options.seed);
  report(0.05, "light");
  light = bakeLight(hall, lamps, [this](double share) { report(0.05 + 0.17 * share, "light"); });
  floor_light = floorLight(hall, light.map);
  report(0.22, "people");
}

void Play::State::drawBackdrops(std::size_t worker) {
  std::optional<HallRenderer> renderer_of_hall;
  for (std::size_t c = worker; c < views.size(); c += thread_count) {
    if (!views[c] && !stop) {
      if (!renderer_of_hall) renderer_of_hall.emplace(hall, covers, grain, light.map);
      Backdrop backdrop = renderer_of_hall->draw(rig.cameras[c]);
      views[c] =
          std::make_unique<SensorView>(rig.cameras[c], static_cast<std::uint32_t>(c), backdrop);
      depth_m[c] = std::move(backdrop.depth_m);
      std::vector<std::byte> bytes;
      views[c]->save(bytes);
      const auto depth = std::as_bytes(std::span(depth_m[c]));
      bytes.insert(bytes.end(), depth.begin(), depth.end());
      const std::lock_guard lock(cache_mutex);
      cache.store("camera-" + std::to_string(c), bytes);
    }
    report(0.24 + 0.36 * static_cast<double>(++backdrops_done) / static_cast<double>(views.size()),
           "cameras");
  }
  const bool ours = worker == views.size() % thread_count;
  if (!ours || !rgbd || rgbd->view() != nullptr || stop) return;
  if (!renderer_of_hall) renderer_of_hall.emplace(hall, covers, grain, light.map);
  const Backdrop backdrop = renderer_of_hall->draw(rgbd->camera());
  const std::lock_guard lock(cache_mutex);
  rgbd->setHall(backdrop, cache);
}

void Play::State::drawMoments(std::size_t worker) {
  PeopleRenderer people(world->cast(), lamps, light.probes, floor_light);
  for (std::size_t c = 0; c < views.size(); ++c) people.addCamera(rig.cameras[c], depth_m[c]);
  if (rgbd) people.addCamera(rgbd->camera(), rgbd->view()->depth_m());
  while (mayDraw(worker)) {
    const auto turn = moments.take();
    if (!turn) {
      // What another one gives back when playing begins is ours.
      if (worker != 0 || moments.ready() == moments.turns()) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      continue;
    }
    if (drawMoment(people, *turn, worker)) {
      finish(*turn);
    } else {
      moments.giveBack(*turn);
    }
  }
}

/// Asked before every picture, so that what follows is late by one of them at most. Waits while a
/// camera is being shown something.
bool Play::State::mayDraw(std::size_t worker) const {
  while (!stop && !moments.full() && playing) {
    // One goes on, behind everybody else, while no camera sends.
    if (worker != 0 || !options.grow) return false;
    yieldToOthers();
    if (!rests()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return !stop && !moments.full();
}

/// False: there was no time to the end of it.
bool Play::State::drawMoment(PeopleRenderer& people, std::uint32_t turn, std::size_t worker) {
  const std::uint32_t moment = moments.momentOf(turn);
  people.setMoment(world->at(moment / kMoments_hz, rig.cameras.front().exposure_s));
  if (moment >= cached) {
    MomentPatches drawn(views.size());
    for (std::size_t c = 0; c < views.size(); ++c) {
      if (!mayDraw(worker)) return false;
      drawn[c] = views[c]->develop(moment, people.draw(c), people.floorShade());
    }
    moments.patches(turn) = std::move(drawn);
  }
  if (!rgbd) return true;
  if (!mayDraw(worker)) return false;
  rgbd->draw(moment, *world, people, views.size());
  return true;
}

void Play::State::finish(std::uint32_t turn) {
  if (!moments.finish(turn)) return;
  const std::uint32_t block = MomentStore::blockOf(turn);
  if (keepsMoments()) storeBlock(block);
  settle(block);
}

void Play::State::settle(std::uint32_t block) {
  if (!moments.full() && !moments.settle(block)) {
    std::fprintf(stderr, "kagami-emulator: studio: no memory for more than %.1f s of play\n",
                 moments.ready() / kMoments_hz);
  }
  const std::lock_guard lock(mutex);
  changed.notify_all();
}

void Play::State::storeBlock(std::uint32_t block) {
  const std::uint32_t first = block * kBlock;
  const auto patches = moments.patchesOfBlock(block);
  const auto bytes = writeMoments(patches);
  const std::lock_guard lock(cache_mutex);
  if (first >= cached) cache.store(fileOfBlock(block), bytes);
  if (rgbd) rgbd->store(cache, first, static_cast<std::uint32_t>(patches.size()));
}

void Play::State::work(std::size_t worker) {
  letOthersGoFirst();
  auto context = openContext();
  if (context) drawBackdrops(worker);
  backdrops_drawn->arrive_and_wait();
  hall_drawn = hasHall();
  if (context && hall_drawn && !stop) drawMoments(worker);
  const std::lock_guard lock(mutex);
  --working;
  changed.notify_all();
}

Play::Play(std::unique_ptr<State> state) : state_(std::move(state)) {}

Play::~Play() {
  state_->stop = true;
  state_->workers.clear();
}

std::expected<std::unique_ptr<Play>, std::string> Play::begin(const StudioOptions& options,
                                                              const Progress& progress) {
  const auto start = Clock::now();
  auto state = std::make_unique<State>(options, progress);
  State& s = *state;
  auto renderer = rendererName();
  if (!renderer) return std::unexpected(renderer.error());
  s.renderer = std::move(*renderer);
  const std::uint64_t wanted = (std::uint64_t{options.cameras} + (options.depth_sensor ? 1 : 0)) *
                               (s.moments.turns() * kUsualMomentBytes +
                                22 * std::uint64_t{options.size.width} * options.size.height);
  if (const std::uint64_t free = rt::availableMemoryBytes(); free != 0 && wanted > free / 2) {
    return std::unexpected("the studio's " + std::to_string(static_cast<int>(options.play_s)) +
                           " s of play need about " + std::to_string(wanted >> 20) +
                           " MiB, more than half of the memory that is free: say a smaller "
                           "--studio-seconds, fewer cameras or a smaller --size");
  }
  s.views.resize(options.cameras);
  s.depth_m.resize(options.cameras);
  if (!options.cache.empty() && options.cache_gib > 0) {
    const std::string key = "pictures " + std::to_string(kPictures) + ", seed " +
                            std::to_string(options.seed) + ", " + std::to_string(options.cameras) +
                            " cameras " + std::to_string(options.size.width) + "x" +
                            std::to_string(options.size.height) + ", " +
                            std::to_string(s.moments.moments()) + " moments, " + s.renderer;
    s.cache = SceneCache(options.cache, key,
                         static_cast<std::uint64_t>(options.cache_gib * 1024 * 1024 * 1024));
    s.loadCache();
  }
  if (s.moments.ready() < s.moments.turns() || !s.hasHall()) {
    s.prepareHall();
    const unsigned threads = std::clamp(std::thread::hardware_concurrency(), 1u, kMostThreads);
    s.workers.reserve(threads);
    s.backdrops_drawn.emplace(threads);
    s.thread_count = threads;
    s.working = threads;
    for (unsigned i = 0; i < threads; ++i) s.workers.emplace_back([&s, i] { s.work(i); });

    const double first_play = s.keepsMoments() ? options.first_play_s * kMoments_hz : 1e9;
    const auto enough =
        static_cast<std::uint32_t>(std::min(static_cast<double>(s.moments.turns()), first_play));
    const double patience_s = s.keepsMoments() ? options.patience_s : 1e6;
    const auto patience = start + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(patience_s));
    std::unique_lock lock(s.mutex);
    while (s.working > 0 &&
           (!s.hall_drawn || (s.moments.ready() < enough &&
                              (s.moments.ready() < 2 * kVariants || Clock::now() < patience)))) {
      s.changed.wait_for(lock, std::chrono::milliseconds(200));
      if (s.moments.ready() > 0)
        s.report(0.6 + 0.4 * std::min(1.0, s.moments.ready() / static_cast<double>(enough)),
                 "people");
    }
    if (!s.hall_drawn || s.moments.ready() == 0)
      return std::unexpected(
          std::string("the studio's pictures cannot be drawn: ") +
          (s.moments.full() ? "there is no memory for them" : "a drawing context was refused"));
  }
  s.playing = true;
  s.report(1, "ready");
  return std::unique_ptr<Play>(new Play(std::move(state)));
}

const StudioRig& Play::rig() const {
  return state_->rig;
}

std::uint32_t Play::momentCount() const {
  return state_->moments.moments();
}

std::uint32_t Play::readyCount() const {
  return state_->moments.ready();
}

const Overlay& Play::overlay(std::uint32_t moment, std::uint32_t camera) const {
  return state_->moments.overlay(moment, camera);
}

std::vector<std::uint8_t> Play::background(std::uint32_t camera, std::uint32_t variant) const {
  return state_->views[camera]->background(variant);
}

const RgbdTrack* Play::rgbd() const {
  return state_->rgbd.get();
}

void Play::rest(rt::Timestamp now) {
  state_->shown_ns.store(rt::toNs(now), std::memory_order_relaxed);
}

void Play::waitFor(std::uint32_t moments) const {
  std::unique_lock lock(state_->mutex);
  state_->changed.wait(lock,
                       [&] { return state_->moments.ready() >= moments || state_->working == 0; });
}

}  // namespace emulator::studio
