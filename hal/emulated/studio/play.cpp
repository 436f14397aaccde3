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
#include <numeric>
#include <optional>
#include <thread>

#include <sched.h>
#include <sys/resource.h>

#include "hal/emulated/studio/covers.h"
#include "hal/emulated/studio/hall.h"
#include "hal/emulated/studio/hall_renderer.h"
#include "hal/emulated/studio/moment_file.h"
#include "hal/emulated/studio/people_renderer.h"
#include "hal/emulated/studio/rgbd_track.h"
#include "hal/emulated/studio/scene_cache.h"
#include "hal/emulated/studio/sensor_view.h"
#include "hal/emulated/studio/studio_gl.h"
#include "hal/emulated/studio/world.h"
#include "rt/memory.h"

namespace emulator::studio {
namespace {

/// To be raised whenever pictures of the same seed change: it tells old caches from new ones.
constexpr int kPictures = 5;
constexpr std::uint32_t kBlock = 10;  ///< moments in one file of the cache
constexpr unsigned kMostThreads = 8;
constexpr std::uint64_t kUsualMomentBytes = 160'000;  // per camera

constexpr rt::Nanoseconds kRest = std::chrono::seconds(1);

using Clock = std::chrono::steady_clock;

/// The thread that calls runs only when nobody else wants the processor.
void yieldToEverybody() {
  const sched_param none{};
  ::sched_setscheduler(0, SCHED_IDLE, &none);
}

/// What light falls on the floor, for the shade that people throw on it.
cv::Mat floorLight(const std::vector<Surface>& hall, const LightMap& map) {
  const auto floor = std::ranges::find(hall, Cover::kFloor, &Surface::cover);
  const LightMap::Place& place = map.places[static_cast<std::size_t>(floor - hall.begin())];
  cv::Mat light(static_cast<int>(place.height), static_cast<int>(place.width), CV_32F);
  for (std::uint32_t y = 0; y < place.height; ++y) {
    for (std::uint32_t x = 0; x < place.width; ++x) {
      const Eigen::Vector4f& t = map.texels[std::size_t{place.y + y} * map.width + place.x + x];
      light.at<float>(static_cast<int>(y), static_cast<int>(x)) =
          0.2126f * t.x() + 0.7152f * t.y() + 0.0722f * t.z();
    }
  }
  return light;
}

}  // namespace

struct Play::State {
  State(const StudioOptions& given, Progress tell)
      : options(given),
        progress(std::move(tell)),
        rig(makeStudioRig(given.cameras, given.size, given.seed)),
        moments(static_cast<std::size_t>(std::lround(given.play_s * kMoments_hz)) / kVariants *
                kVariants),
        order(given.only) {
    if (given.depth_sensor) {
      rgbd = std::make_unique<RgbdTrack>(given.seed, static_cast<std::uint32_t>(moments.size()));
    }
    if (!order.empty()) return;
    order.resize(moments.size());
    std::iota(order.begin(), order.end(), 0u);
  }

  void loadCache();
  [[nodiscard]] bool keepsMoments() const { return options.only.empty(); }
  void prepareHall();
  void work(std::size_t worker);
  void drawBackdrops(std::size_t worker);
  void drawMoments(std::size_t worker);
  void finish(std::uint32_t turn, MomentPatches patches);
  void storeBlock(std::uint32_t block);
  [[nodiscard]] bool hasHall() const {
    return std::ranges::all_of(views, [](const auto& view) { return view != nullptr; }) &&
           (!rgbd || rgbd->view() != nullptr);
  }
  [[nodiscard]] bool isDrawn(std::uint32_t turn) {
    const std::lock_guard lock(mutex);
    return drawn[turn] != 0;
  }
  [[nodiscard]] bool rests() const { return rt::now() < rt::fromNs(shown_ns.load()) + kRest; }
  void tell(double share, const char* what) {
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
  std::vector<MomentPatches> moments;
  std::unique_ptr<RgbdTrack> rgbd;   // none without a depth sensor
  std::vector<std::uint32_t> order;  // of drawing: a moment for every turn
  std::vector<std::uint8_t> drawn;   // by turn; guarded by mutex
  std::uint32_t cached = 0;          // of the first so many moments we have the cameras' pictures
  std::atomic<std::uint32_t> next = 0;
  std::atomic<std::uint32_t> ready = 0;
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
    tell(0.5 * (c + 1) / cameras, "reading");
  }
  if (rgbd) rgbd->load(cache);
  for (std::uint32_t first = 0; keepsMoments() && first < moments.size(); first += kBlock) {
    const auto bytes = cache.load("moments-" + std::to_string(first / kBlock));
    if (!bytes) break;
    const auto count =
        std::min<std::uint32_t>(kBlock, static_cast<std::uint32_t>(moments.size()) - first);
    auto block = readMoments(*bytes, count, cameras, options.size);
    if (!block) break;
    if (rgbd) rgbd->load(cache, first, count);
    for (std::uint32_t i = 0; i < count; ++i) {
      moments[first + i] = std::move((*block)[i]);
      drawn[first + i] = !rgbd || rgbd->has(first + i) ? 1 : 0;
    }
    cached = first + count;
    tell(0.5 + 0.5 * first / static_cast<double>(moments.size()), "reading");
  }
  while (ready < cached && drawn[ready] != 0) ++ready;
  next = ready.load();
}

void Play::State::prepareHall() {
  tell(0.01, "hall");
  hall = buildHall(options.seed);
  lamps = hallLamps(options.seed);
  std::jthread dressing([this] { world = std::make_unique<World>(options.seed); });
  covers = drawCovers(options.seed);
  grain = drawFloorGrain(options.seed);
  tell(0.05, "light");
  light = bakeLight(hall, lamps, [this](double share) { tell(0.05 + 0.17 * share, "light"); });
  floor_light = floorLight(hall, light.map);
  tell(0.22, "people");
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
    tell(0.24 + 0.36 * static_cast<double>(++backdrops_done) / static_cast<double>(views.size()),
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
  bool yielding = false;
  while (!stop) {
    if (playing) {
      // One goes on, behind everybody else, while no camera sends.
      if (worker != 0 || !options.grow) return;
      if (!yielding) yieldToEverybody();
      yielding = true;
      if (rests()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        continue;
      }
    }
    const std::uint32_t turn = next++;
    if (turn >= order.size()) return;
    if (isDrawn(turn)) continue;
    const std::uint32_t moment = order[turn];
    const double exposure_s = rig.cameras.front().exposure_s;
    people.setMoment(world->at(moment / kMoments_hz, exposure_s));
    const bool kept = moment < cached;
    MomentPatches patches = kept ? std::move(moments[moment]) : MomentPatches(views.size());
    for (std::size_t c = 0; c < views.size() && !kept && !stop; ++c) {
      patches[c] = views[c]->develop(moment, people.draw(c), people.floorShade());
    }
    if (rgbd && !stop) rgbd->draw(moment, *world, people, views.size());
    if (!stop) finish(turn, std::move(patches));
  }
}

void Play::State::finish(std::uint32_t turn, MomentPatches patches) {
  moments[order[turn]] = std::move(patches);
  std::uint32_t block_done = UINT32_MAX;
  {
    const std::lock_guard lock(mutex);
    drawn[turn] = 1;
    std::uint32_t count = ready;
    while (count < order.size() && drawn[count] != 0) ++count;
    ready = count;
    const std::uint32_t first = turn / kBlock * kBlock;
    const auto last = std::min<std::size_t>(first + kBlock, order.size());
    if (std::all_of(drawn.begin() + first, drawn.begin() + static_cast<std::ptrdiff_t>(last),
                    [](auto d) { return d != 0; }))
      block_done = turn / kBlock;
  }
  changed.notify_all();
  if (keepsMoments() && block_done != UINT32_MAX) storeBlock(block_done);
}

void Play::State::storeBlock(std::uint32_t block) {
  const std::size_t first = std::size_t{block} * kBlock;
  const std::size_t count = std::min<std::size_t>(kBlock, moments.size() - first);
  const auto bytes = writeMoments(std::span(moments).subspan(first, count));
  const std::lock_guard lock(cache_mutex);
  if (first >= cached) cache.store("moments-" + std::to_string(block), bytes);
  if (rgbd)
    rgbd->store(cache, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count));
}

void Play::State::work(std::size_t worker) {
  ::setpriority(PRIO_PROCESS, 0, 10);  // of this thread
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
  {
    auto context = openContext();
    if (!context) return std::unexpected(context.error());
    s.renderer = (*context)->renderer() + ", " + (*context)->version();
  }
  const std::uint64_t wanted = (std::uint64_t{options.cameras} + (options.depth_sensor ? 1 : 0)) *
                               (s.order.size() * kUsualMomentBytes +
                                22 * std::uint64_t{options.size.width} * options.size.height);
  if (const std::uint64_t free = rt::availableMemoryBytes(); free != 0 && wanted > free / 2) {
    return std::unexpected("the studio's " + std::to_string(static_cast<int>(options.play_s)) +
                           " s of play need about " + std::to_string(wanted >> 20) +
                           " MiB, more than half of the memory that is free: say a smaller "
                           "--studio-seconds, fewer cameras or a smaller --size");
  }
  s.views.resize(options.cameras);
  s.depth_m.resize(options.cameras);
  s.drawn.assign(s.order.size(), 0);
  if (!options.cache.empty() && options.cache_gib > 0) {
    const std::string key = "pictures " + std::to_string(kPictures) + ", seed " +
                            std::to_string(options.seed) + ", " + std::to_string(options.cameras) +
                            " cameras " + std::to_string(options.size.width) + "x" +
                            std::to_string(options.size.height) + ", " +
                            std::to_string(s.moments.size()) + " moments, " + s.renderer;
    s.cache = SceneCache(options.cache, key,
                         static_cast<std::uint64_t>(options.cache_gib * 1024 * 1024 * 1024));
    s.loadCache();
  }
  if (s.ready < s.order.size() || !s.hasHall()) {
    s.prepareHall();
    const unsigned threads = std::clamp(std::thread::hardware_concurrency(), 1u, kMostThreads);
    s.workers.reserve(threads);
    s.backdrops_drawn.emplace(threads);
    s.thread_count = threads;
    s.working = threads;
    for (unsigned i = 0; i < threads; ++i) s.workers.emplace_back([&s, i] { s.work(i); });

    const double first_play = s.keepsMoments() ? options.first_play_s * kMoments_hz : 1e9;
    const auto enough =
        static_cast<std::uint32_t>(std::min(static_cast<double>(s.order.size()), first_play));
    const double patience_s = s.keepsMoments() ? options.patience_s : 1e6;
    const auto patience = start + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(patience_s));
    std::unique_lock lock(s.mutex);
    while (s.working > 0 && (!s.hall_drawn || (s.ready < enough && (s.ready < 2 * kVariants ||
                                                                    Clock::now() < patience)))) {
      s.changed.wait_for(lock, std::chrono::milliseconds(200));
      if (s.ready > 0)
        s.tell(0.6 + 0.4 * std::min(1.0, s.ready / static_cast<double>(enough)), "people");
    }
    if (!s.hall_drawn || s.ready < std::min<std::size_t>(kVariants, s.order.size()))
      return std::unexpected(
          "the studio's pictures cannot be drawn: a drawing context was refused");
  }
  s.playing = true;
  s.tell(1, "ready");
  return std::unique_ptr<Play>(new Play(std::move(state)));
}

const StudioRig& Play::rig() const {
  return state_->rig;
}

std::uint32_t Play::momentCount() const {
  return static_cast<std::uint32_t>(state_->moments.size());
}

std::uint32_t Play::readyCount() const {
  return state_->ready.load(std::memory_order_acquire);
}

const Patch& Play::patch(std::uint32_t moment, std::uint32_t camera) const {
  return state_->moments[moment][camera];
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
  state_->changed.wait(lock, [&] { return state_->ready >= moments || state_->working == 0; });
}

}  // namespace emulator::studio
