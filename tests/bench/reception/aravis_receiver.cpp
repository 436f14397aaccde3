#include <atomic>

#include "hal/aravis/gobject.h"
#include "hal/aravis/profile_push.h"
#include "hal/aravis/stream_socket.h"
#include "tests/bench/reception/stream_receiver.h"

namespace bench {
namespace {

using hal::aravis::GlibError;
using hal::aravis::Ref;

class AravisStream {
 public:
  AravisStream() = default;
  AravisStream(const AravisStream&) = delete;
  AravisStream& operator=(const AravisStream&) = delete;
  ~AravisStream() {
    closing_.store(true, std::memory_order_release);
    if (camera_) arv_camera_stop_acquisition(camera_.get(), nullptr);
    stream_.reset();  // joins the receive thread
  }

  std::expected<void, std::string> open(const hal::CameraProfile& profile,
                                        const ReceptionSetup& setup) {
    receive_ = setup.receive;
    GlibError error;
    camera_.reset(arv_camera_new(profile.address.c_str(), error.out()));
    if (!camera_) return std::unexpected(profile.address + ": " + error.message());
    if (auto pushed = hal::aravis::pushProfile(camera_.get(), profile); !pushed) return pushed;
    arv_camera_gv_set_stream_options(camera_.get(), ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
    arv_camera_gv_set_packet_size_adjustment(camera_.get(), ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
    stream_.reset(
        arv_camera_create_stream(camera_.get(), &AravisStream::onStream, this, error.out()));
    if (!stream_) return std::unexpected(profile.address + ": " + error.message());
    raw_ = stream_.get();
    const auto socket_buffer = static_cast<gint>(profile.socket_buffer_bytes);
    hal::aravis::sizeReceiveBuffer(arv_gv_stream_get_port(ARV_GV_STREAM(raw_)), socket_buffer);
    g_object_set(raw_,                                                //
                 "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED,  //
                 "socket-buffer-size", socket_buffer,                 //
                 "initial-packet-timeout", 0U, nullptr);
    for (std::uint32_t i = 0; i < setup.slots(); ++i) {
      arv_stream_push_buffer(raw_, arv_buffer_new_allocate(setup.frameBytes()));
    }
    arv_camera_start_acquisition(camera_.get(), error.out());
    if (error) return std::unexpected(profile.address + ": " + error.message());
    return {};
  }

  [[nodiscard]] std::uint64_t frames() const { return frames_.load(std::memory_order_relaxed); }

 private:
  static void onStream(void* user, ArvStreamCallbackType type, ArvBuffer* /*null at begin*/) {
    auto& self = *static_cast<AravisStream*>(user);
    if (type == ARV_STREAM_CALLBACK_TYPE_INIT) (void)rt::applyToCurrentThread(self.receive_);
    if (type != ARV_STREAM_CALLBACK_TYPE_BUFFER_DONE) return;
    if (self.closing_.load(std::memory_order_acquire)) return;
    ArvBuffer* buffer = arv_stream_try_pop_buffer(self.raw_);
    if (buffer == nullptr) return;
    if (arv_buffer_get_status(buffer) == ARV_BUFFER_STATUS_SUCCESS) {
      self.frames_.store(self.frames() + 1, std::memory_order_relaxed);
    }
    arv_stream_push_buffer(self.raw_, buffer);
  }

  rt::ThreadConfig receive_;
  Ref<ArvCamera> camera_;
  Ref<ArvStream> stream_;
  ArvStream* raw_ = nullptr;
  std::atomic<bool> closing_{false};
  std::atomic<std::uint64_t> frames_{0};
};

}  // namespace

MadeReceiver receiveByAravis(const ReceptionSetup& setup) {
  return openStreams<AravisStream>(setup);
}

}  // namespace bench
