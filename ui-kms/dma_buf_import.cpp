#include "ui-kms/dma_buf_import.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>

#include "rt/dma_buf.h"

namespace ui {
namespace {

// As in the kernel's drm_fourcc.h.
constexpr EGLint kFormatR8 = 'R' | '8' << 8 | ' ' << 16 | ' ' << 24;
constexpr EGLuint64KHR kModifierLinear = 0;

using ImageTargetTexture = void(GL_APIENTRY*)(GLenum target, void* image);

bool lists(const char* extensions, std::string_view name) {
  std::string_view rest = extensions != nullptr ? extensions : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == name) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

template <class Function>
Function functionOf(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

/// Whether the driver must get the layout that rows simply follow each other; otherwise it assumes
/// that layout of memory without a description.
bool namesLinearModifier(EGLDisplay display, const char* extensions) {
  if (!lists(extensions, "EGL_EXT_image_dma_buf_import_modifiers")) return false;
  const auto query = functionOf<PFNEGLQUERYDMABUFMODIFIERSEXTPROC>("eglQueryDmaBufModifiersEXT");
  EGLint count = 0;
  if (query == nullptr || query(display, kFormatR8, 0, nullptr, nullptr, &count) == EGL_FALSE) {
    return false;
  }
  std::vector<EGLuint64KHR> modifiers(static_cast<std::size_t>(count));
  std::vector<EGLBoolean> external_only(modifiers.size());
  query(display, kFormatR8, count, modifiers.data(), external_only.data(), &count);
  return std::ranges::find(modifiers, kModifierLinear) != modifiers.end();
}

}  // namespace

struct DmaBufImport::Functions {
  PFNEGLCREATEIMAGEKHRPROC create_image;
  PFNEGLDESTROYIMAGEKHRPROC destroy_image;
  ImageTargetTexture image_target_texture;
};

std::expected<std::unique_ptr<DmaBufImport>, std::string> DmaBufImport::create() {
  EGLDisplay display = eglGetCurrentDisplay();
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  if (!lists(extensions, "EGL_EXT_image_dma_buf_import")) {
    return std::unexpected("this EGL lists no EGL_EXT_image_dma_buf_import");
  }
  const auto* gl_extensions = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
  if (!lists(gl_extensions, "GL_OES_EGL_image")) {
    return std::unexpected("this OpenGL ES lists no GL_OES_EGL_image");
  }
  const Functions functions{
      .create_image = functionOf<PFNEGLCREATEIMAGEKHRPROC>("eglCreateImageKHR"),
      .destroy_image = functionOf<PFNEGLDESTROYIMAGEKHRPROC>("eglDestroyImageKHR"),
      .image_target_texture = functionOf<ImageTargetTexture>("glEGLImageTargetTexture2DOES")};
  if (functions.create_image == nullptr || functions.destroy_image == nullptr ||
      functions.image_target_texture == nullptr) {
    return std::unexpected("this EGL lists its image functions but does not have them");
  }
  return std::unique_ptr<DmaBufImport>(
      new DmaBufImport(display, functions, namesLinearModifier(display, extensions)));
}

DmaBufImport::DmaBufImport(void* display, const Functions& functions, bool names_modifier)
    : display_(display),
      functions_(std::make_unique<const Functions>(functions)),
      names_modifier_(names_modifier) {
  GLuint name = 0;
  glGenTextures(1, &name);
  texture_ = gl::Texture(name);
}

DmaBufImport::~DmaBufImport() {
  for (const auto& [slot, image] : images_) {
    if (image != nullptr) functions_->destroy_image(display_, image);
  }
}

GLuint DmaBufImport::tryImport(const hal::SourceImage& source) {
  if (!source.dma_buf.valid()) return 0;
  void* const image = imageOf(source);
  if (image == nullptr || !rt::publishToDevices(source.dma_buf.fd)) return 0;
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  // Bound again for each picture: only then does the driver read what was written since.
  functions_->image_target_texture(GL_TEXTURE_2D, image);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return glGetError() == GL_NO_ERROR ? texture_.get() : 0;
}

void* DmaBufImport::imageOf(const hal::SourceImage& source) {
  const auto [known, is_new] = images_.try_emplace(
      Slot{source.dma_buf.buffer, source.dma_buf.offset_bytes, source.width_px, source.height_px},
      nullptr);
  if (!is_new) return known->second;
  std::vector<EGLint> attributes = {EGL_WIDTH,
                                    static_cast<EGLint>(source.width_px),
                                    EGL_HEIGHT,
                                    static_cast<EGLint>(source.height_px),
                                    EGL_LINUX_DRM_FOURCC_EXT,
                                    kFormatR8,
                                    EGL_DMA_BUF_PLANE0_FD_EXT,
                                    source.dma_buf.fd,
                                    EGL_DMA_BUF_PLANE0_OFFSET_EXT,
                                    static_cast<EGLint>(source.dma_buf.offset_bytes),
                                    EGL_DMA_BUF_PLANE0_PITCH_EXT,
                                    static_cast<EGLint>(source.width_px)};
  if (names_modifier_) {
    attributes.insert(attributes.end(), {EGL_DMA_BUF_PLANE0_MODIFIER_LO_EXT, 0,
                                         EGL_DMA_BUF_PLANE0_MODIFIER_HI_EXT, 0});
  }
  attributes.push_back(EGL_NONE);
  known->second = functions_->create_image(display_, EGL_NO_CONTEXT, EGL_LINUX_DMA_BUF_EXT, nullptr,
                                           attributes.data());
  return known->second;
}

}  // namespace ui
