#include "hal/aravis/aravis_camera.h"

#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

#include "hal/aravis/arrival_stamps.h"
#include "hal/aravis/camera_probe.h"
#include "hal/aravis/frame_id.h"
#include "hal/aravis/gobject.h"
#include "hal/aravis/network_checks.h"
#include "hal/aravis/profile_push.h"
#include "hal/aravis/resend.h"
#include "hal/aravis/stream_socket.h"

namespace hal::aravis {
namespace {

constexpr rt::Nanoseconds kAnswerTimeout = std::chrono::milliseconds(500);

FrameStatus statusOf(ArvBuffer* buffer, const CameraProfile& profile) {
  switch (arv_buffer_get_status(buffer)) {
    case ARV_BUFFER_STATUS_SUCCESS: {
      const bool as_ordered =
          arv_buffer_get_image_width(buffer) == static_cast<int>(profile.width_px) &&
          arv_buffer_get_image_height(buffer) == static_cast<int>(profile.height_px);
      return as_ordered ? FrameStatus::kComplete : FrameStatus::kWrongSize;
    }
    case ARV_BUFFER_STATUS_SIZE_MISMATCH:
      return FrameStatus::kWrongSize;
    case ARV_BUFFER_STATUS_ABORTED:
    case ARV_BUFFER_STATUS_CLEARED:
      return FrameStatus::kAborted;
    default:
      return FrameStatus::kIncomplete;
  }
}

class AravisCamera final : public Camera {
 public:
  AravisCamera(CameraProfile profile, rt::ThreadConfig receive, Ref<ArvCamera> camera,
               std::vector<std::string> remarks)
      : profile_(std::move(profile)),
        receive_(std::move(receive)),
        camera_(std::move(camera)),
        remarks_(std::move(remarks)) {}
  ~AravisCamera() override { stop(); }

  std::expected<void, std::string> start(FrameSink& sink,
                                         std::span<const std::span<std::byte>> slots,
                                         std::span<const std::uint32_t> first_slots) override;
  void stop() override;
  [[nodiscard]] CameraStatistics statistics() const override;
  [[nodiscard]] std::vector<std::string> remarks() const override { return remarks_; }

 private:
  static void onStream(void* self, ArvStreamCallbackType type, ArvBuffer* /*null at begin*/) {
    static_cast<AravisCamera*>(self)->onStream(type);
  }
  void onStream(ArvStreamCallbackType type);
  void deliver();
  void deliver(ArvBuffer* buffer);
  void configureStream();
  [[nodiscard]] std::string fail(const std::string& what) const {
    return profile_.name + " (" + profile_.address + "): " + what;
  }

  const CameraProfile profile_;
  const rt::ThreadConfig receive_;
  Ref<ArvCamera> camera_;
  const std::vector<std::string> remarks_;
  Ref<ArvStream> stream_;
  std::vector<Ref<ArvBuffer>> buffers_;  // one per slot, in slot order
  std::atomic<bool> delivering_{false};  // false while the stream is torn down: it still calls us

  // Owned by the receive thread while streaming.
  FrameSink* sink_ = nullptr;
  FrameIdUnwrapper frame_ids_;
  ArrivalStamps stamps_;
};

std::expected<void, std::string> AravisCamera::start(FrameSink& sink,
                                                     std::span<const std::span<std::byte>> slots,
                                                     std::span<const std::uint32_t> first_slots) {
  stop();
  sink_ = &sink;
  frame_ids_ = {};
  stamps_ = {};

  GlibError error;
  arv_camera_gv_set_stream_options(camera_.get(), ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
  arv_camera_gv_set_packet_size_adjustment(camera_.get(), ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
  stream_.reset(
      arv_camera_create_stream(camera_.get(), &AravisCamera::onStream, this, error.out()));
  if (!stream_) return std::unexpected(fail("no stream: " + error.message()));
  configureStream();

  buffers_.reserve(slots.size());
  for (std::size_t slot = 0; slot < slots.size(); ++slot) {
    buffers_.emplace_back(arv_buffer_new_full(slots[slot].size(), slots[slot].data(),
                                              reinterpret_cast<void*>(slot), nullptr));
  }
  for (const std::uint32_t slot : first_slots) {
    arv_stream_push_buffer(stream_.get(), ARV_BUFFER(g_object_ref(buffers_[slot].get())));
  }
  delivering_.store(true, std::memory_order_release);
  arv_camera_start_acquisition(camera_.get(), error.out());
  if (error) {
    stop();
    return std::unexpected(fail("does not start: " + error.message()));
  }
  return {};
}

void AravisCamera::configureStream() {
  ArvStream* stream = stream_.get();
  sizeReceiveBuffer(arv_gv_stream_get_port(ARV_GV_STREAM(stream)),
                    static_cast<int>(profile_.socket_buffer_bytes));
  g_object_set(stream,                                              //
               "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED,  //
               "socket-buffer-size", static_cast<gint>(profile_.socket_buffer_bytes), nullptr);
  const char* model = arv_camera_get_model_name(camera_.get(), nullptr);
  applyResend(stream, resendPolicyFor(profile_, model != nullptr ? model : ""));
}

void AravisCamera::stop() {
  delivering_.store(false, std::memory_order_release);
  if (!stream_) return;
  arv_camera_stop_acquisition(camera_.get(), nullptr);
  // Not reset(): it clears the pointer first, and deliver() may use it until the thread is joined.
  g_object_unref(stream_.get());  // joins the receive thread
  (void)stream_.release();
  buffers_.clear();
}

CameraStatistics AravisCamera::statistics() const {
  CameraStatistics s;
  if (!stream_) return s;
  guint64 completed = 0, failures = 0, underruns = 0, resent = 0, missing = 0;
  arv_stream_get_statistics(stream_.get(), &completed, &failures, &underruns);
  arv_gv_stream_get_statistics(ARV_GV_STREAM(stream_.get()), &resent, &missing);
  return {completed, failures, resent, missing, underruns};
}

void AravisCamera::onStream(ArvStreamCallbackType type) {
  switch (type) {
    case ARV_STREAM_CALLBACK_TYPE_INIT:
      (void)rt::applyToCurrentThread(receive_);  // what was granted shows in listTasks()
      break;
    case ARV_STREAM_CALLBACK_TYPE_START_BUFFER:
      stamps_.begin(rt::now());
      break;
    case ARV_STREAM_CALLBACK_TYPE_BUFFER_DONE:
      if (delivering_.load(std::memory_order_acquire)) deliver();
      break;
    default:
      break;
  }
}

/// All that is in the queue: a camera that still sent while its stream was made has left frames in
/// it, and each would delay all later ones by a frame.
void AravisCamera::deliver() {
  while (ArvBuffer* const buffer = arv_stream_try_pop_buffer(stream_.get())) deliver(buffer);
}

void AravisCamera::deliver(ArvBuffer* buffer) {
  const rt::Timestamp last_packet = rt::now();
  const std::uint64_t id = arv_buffer_get_frame_id(buffer);
  const bool whole = arv_buffer_get_status(buffer) == ARV_BUFFER_STATUS_SUCCESS;
  const FrameArrival arrival{
      .slot = static_cast<std::uint32_t>(
          reinterpret_cast<std::uintptr_t>(arv_buffer_get_user_data(buffer))),
      .status = statusOf(buffer, profile_),
      .frame_id = whole ? frame_ids_.unwrap(id) : frame_ids_.ofDamaged(id),
      .camera_clock = rt::Nanoseconds{static_cast<std::int64_t>(arv_buffer_get_timestamp(buffer))},
      .first_packet = stamps_.deliver(last_packet),
      .last_packet = last_packet,
  };
  g_object_unref(buffer);  // buffers_ keeps it; the queue's reference came with the pop

  const std::uint32_t next = sink_->onFrame(arrival);
  arv_stream_push_buffer(stream_.get(), ARV_BUFFER(g_object_ref(buffers_[next].get())));
}

/// Opened by address over the interface that the routes name. Aravis' own opening by name looks
/// through every interface and holds a lock meanwhile: one dead camera would delay all the others.
Ref<ArvCamera> openByAddress(const std::string& address, GlibError& error) {
  const std::string here = localAddressTowards(address);
  const Ref<GInetAddress> interface{g_inet_address_new_from_string(here.c_str())};
  const Ref<GInetAddress> camera{g_inet_address_new_from_string(address.c_str())};
  if (!interface || !camera) return nullptr;
  // Aravis reads a camera's description with one parser state and one table of formats for the
  // whole process. The probe has already left out cameras that do not answer, so none waits here.
  static std::mutex one_description_at_a_time;
  const std::lock_guard lock(one_description_at_a_time);
  const Ref<ArvDevice> device{arv_gv_device_new(interface.get(), camera.get(), error.out())};
  if (!device) return nullptr;
  return Ref<ArvCamera>{arv_camera_new_with_device(device.get(), error.out())};
}

}  // namespace

std::expected<std::unique_ptr<Camera>, std::string> openCamera(const CameraProfile& profile,
                                                               const rt::ThreadConfig& receive) {
  const auto fail = [&](const std::string& what) {
    return std::unexpected(profile.name + " (" + profile.address + "): " + what);
  };
  // A dead address costs a fraction of what Aravis waits for one.
  if (probeCamera(profile.address, kAnswerTimeout).answer == CameraAnswer::kNone) {
    return fail("no answer: check its cable, power and address");
  }
  GlibError error;
  Ref<ArvCamera> camera = openByAddress(profile.address, error);
  if (!camera) {
    return fail("no answer (" + error.message() + "): check its cable, power and address");
  }
  // A camera that another program controls can be opened, too, but only for reading.
  if (arv_gv_device_is_controller(ARV_GV_DEVICE(arv_camera_get_device(camera.get()))) == FALSE) {
    return fail("another program controls it: end that program");
  }
  if (auto pushed = pushProfile(camera.get(), profile); !pushed) {
    return std::unexpected(pushed.error());
  }
  const auto payload = arv_camera_get_payload(camera.get(), error.out());
  const auto wanted = std::size_t{profile.width_px} * profile.height_px;
  if (error || payload != wanted) {
    return fail("sends frames of " + std::to_string(payload) +
                " bytes, its size and format ask for " + std::to_string(wanted));
  }
  auto remarks = checkNetwork(camera.get(), profile);
  return std::make_unique<AravisCamera>(profile, receive, std::move(camera), std::move(remarks));
}

}  // namespace hal::aravis
