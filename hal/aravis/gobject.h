#pragma once

#include <memory>
#include <string>

#include <arv.h>

namespace hal::aravis {

struct Unref {
  void operator()(gpointer object) const noexcept { g_object_unref(object); }
};

/// One reference to a GObject.
template <class T>
using Ref = std::unique_ptr<T, Unref>;

/// Collects the outcome of GLib calls: `GlibError e; call(..., e.out()); if (e) ... e.message()`.
class GlibError {
 public:
  GlibError() = default;
  ~GlibError() { g_clear_error(&error_); }
  GlibError(const GlibError&) = delete;
  GlibError& operator=(const GlibError&) = delete;

  [[nodiscard]] GError** out() {
    g_clear_error(&error_);
    return &error_;
  }
  explicit operator bool() const { return error_ != nullptr; }
  [[nodiscard]] std::string message() const { return error_ != nullptr ? error_->message : ""; }

 private:
  GError* error_ = nullptr;
};

}  // namespace hal::aravis
