#include "hal/openni/wire.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <type_traits>

#include <sys/socket.h>

namespace hal::openni {

static_assert(std::is_trivially_copyable_v<WireMessage>);

void WireMessage::setText(std::string_view to) {
  text.fill('\0');
  std::copy_n(to.begin(), std::min(to.size(), text.size() - 1), text.begin());
}

std::string_view WireMessage::textView() const {
  return {text.data(), ::strnlen(text.data(), text.size())};
}

bool send(int socket, const WireMessage& message, int descriptor) {
  iovec part{.iov_base = const_cast<WireMessage*>(&message), .iov_len = sizeof message};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(int))> control{};
  if (descriptor >= 0) {
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    cmsghdr* first = CMSG_FIRSTHDR(&header);
    first->cmsg_level = SOL_SOCKET;
    first->cmsg_type = SCM_RIGHTS;
    first->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(first), &descriptor, sizeof descriptor);
  }
  for (;;) {
    if (::sendmsg(socket, &header, MSG_NOSIGNAL) >= 0) return true;
    if (errno != EINTR) return false;
  }
}

ReceiveResult tryReceive(int socket, Received& received) {
  iovec part{.iov_base = &received.message, .iov_len = sizeof received.message};
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(int))> control{};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  header.msg_control = control.data();
  header.msg_controllen = control.size();
  ssize_t bytes = 0;
  do {
    bytes = ::recvmsg(socket, &header, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
  } while (bytes < 0 && errno == EINTR);
  if (bytes < 0) {
    return errno == EAGAIN || errno == EWOULDBLOCK ? ReceiveResult::kNothing
                                                   : ReceiveResult::kClosed;
  }
  if (bytes == 0) return ReceiveResult::kClosed;
  received.descriptor = rt::UniqueFd();
  const cmsghdr* first = CMSG_FIRSTHDR(&header);
  if (first != nullptr && first->cmsg_type == SCM_RIGHTS &&
      first->cmsg_len == CMSG_LEN(sizeof(int))) {
    int descriptor = -1;
    std::memcpy(&descriptor, CMSG_DATA(first), sizeof descriptor);
    received.descriptor = rt::UniqueFd(descriptor);
  }
  const bool whole =
      bytes == static_cast<ssize_t>(sizeof received.message) && (header.msg_flags & MSG_TRUNC) == 0;
  return whole && received.message.version == WireMessage::kVersion ? ReceiveResult::kMessage
                                                                    : ReceiveResult::kForeign;
}

}  // namespace hal::openni
