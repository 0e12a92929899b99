#include "sim/compute/gl_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

namespace fude {
namespace {

constexpr int least_version = 43;  // compute shaders

tl::unexpected<Error> no_opengl(const std::string& why) {
  return failure(Fault::unsupported, "no OpenGL 4.3 here (" + why + "): use --backend cpu");
}

// libepoxy ends the program where a library is missing, so that is found out before it is asked.
bool library_exists(const char* name) {
  void* library = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
  if (library) dlclose(library);
  return library != nullptr;
}

bool has_extension(EGLDisplay display, std::string_view name) {
  const char* all = eglQueryString(display, EGL_EXTENSIONS);
  if (!all) return false;
  const std::string padded = " " + std::string(all) + " ";
  return padded.find(" " + std::string(name) + " ") != std::string::npos;
}

// Every graphics device, then whatever Mesa would choose.
std::vector<EGLDisplay> displays() {
  std::vector<EGLDisplay> found;
  if (has_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
      has_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    if (eglQueryDevicesEXT(devices.size(), devices.data(), &count))
      for (EGLint i = 0; i < count; ++i)
        found.push_back(
            eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr));
  }
  if (has_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    found.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  std::erase(found, EGL_NO_DISPLAY);
  return found;
}

}  // namespace

bool is_software_renderer(std::string_view renderer) {
  constexpr std::array<std::string_view, 5> programs = {"llvmpipe", "softpipe", "swrast", "SwiftShader",
                                                        "Software Rasterizer"};
  return std::ranges::any_of(programs,
                             [&](std::string_view name) { return renderer.find(name) != renderer.npos; });
}

Result<GlContext> GlContext::open(Renderer wanted) {
  setenv("EGL_LOG_LEVEL", "fatal", 0);  // what is wrong is said once, by us
  if (!library_exists("libEGL.so.1")) return no_opengl("libEGL is missing; install libegl1");
  if (!library_exists("libGL.so.1") && !library_exists("libOpenGL.so.0"))
    return no_opengl("libGL is missing; install libgl1");
  std::optional<GlContext> software;
  std::string why = "no driver offers a context without a display; install libgl1-mesa-dri";
  for (EGLDisplay display : displays()) {
    Result<GlContext> context = on_display(display);
    if (!context) {
      why = context.error().message;
    } else if (!is_software_renderer(context->renderer_)) {
      return context;
    } else {
      context->release();
      software = std::move(*context);
    }
  }
  if (!software) return no_opengl(why);
  if (wanted == Renderer::hardware_only)
    return no_opengl("only the software renderer " + software->renderer_);
  software->make_current();
  return std::move(*software);
}

Result<GlContext> GlContext::on_display(void* display) {
  if (!eglInitialize(display, nullptr, nullptr))
    return failure(Fault::unsupported, "the driver does not start");
  if (!has_extension(display, "EGL_KHR_surfaceless_context") ||
      !has_extension(display, "EGL_KHR_no_config_context"))
    return failure(Fault::unsupported, "the driver needs a surface to draw on");
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                               4,
                               EGL_CONTEXT_MINOR_VERSION,
                               3,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_NONE};
  if (!eglBindAPI(EGL_OPENGL_API)) return failure(Fault::unsupported, "the driver has only OpenGL ES");
  EGLContext raw = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
  if (raw == EGL_NO_CONTEXT) return failure(Fault::unsupported, "the driver's OpenGL is older");
  GlContext context(display, raw);
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, raw))
    return failure(Fault::unsupported, "the driver's context cannot be used");
  if (epoxy_gl_version() < least_version) return failure(Fault::unsupported, "the driver's OpenGL is older");
  context.version_ = reinterpret_cast<const char*>(glGetString(GL_VERSION));
  context.renderer_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return context;
}

GlContext::GlContext(GlContext&& other) noexcept
    : display_(other.display_),
      context_(std::exchange(other.context_, EGL_NO_CONTEXT)),
      version_(std::move(other.version_)),
      renderer_(std::move(other.renderer_)) {}

GlContext& GlContext::operator=(GlContext&& other) noexcept {
  std::swap(display_, other.display_);
  std::swap(context_, other.context_);
  std::swap(version_, other.version_);
  std::swap(renderer_, other.renderer_);
  return *this;
}

GlContext::~GlContext() {
  if (context_ == EGL_NO_CONTEXT) return;
  release();
  eglDestroyContext(display_, context_);
}

GlContext::Use::Use(const GlContext& context)
    : own_display_(context.display_),
      display_(eglGetCurrentDisplay()),
      draw_(eglGetCurrentSurface(EGL_DRAW)),
      read_(eglGetCurrentSurface(EGL_READ)),
      context_(eglGetCurrentContext()) {
  context.make_current();
}

GlContext::Use::~Use() {
  const bool none = context_ == EGL_NO_CONTEXT;
  eglMakeCurrent(none ? own_display_ : display_, draw_, read_, context_);
}

void GlContext::make_current() const {
  eglBindAPI(EGL_OPENGL_API);
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
}

void GlContext::release() const {
  eglBindAPI(EGL_OPENGL_API);
  if (eglGetCurrentContext() == context_)
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

}  // namespace fude
