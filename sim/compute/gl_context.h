// An OpenGL context that needs no display: EGL without a surface. One thread at a time uses it; it lives
// beside a window's context without touching it.
#pragma once

#include <string>
#include <string_view>

#include "signal/result.h"

namespace fude {

// Whether GL_RENDERER names a program that draws on the processor (llvmpipe, softpipe, SwiftShader …).
bool is_software_renderer(std::string_view renderer);

class GlContext {
 public:
  enum class Renderer { hardware_only, any };

  // A core context of OpenGL 4.3 or later, on the first graphics card that offers one, else, where `any`
  // will do, on a software renderer. It is current on the calling thread.
  // Errors: unsupported, with what is missing and what to do.
  static Result<GlContext> open(Renderer wanted);

  GlContext(GlContext&& other) noexcept;
  GlContext& operator=(GlContext&& other) noexcept;
  ~GlContext();

  // Makes it the calling thread's context; `release` first on the thread that had it.
  void make_current() const;
  void release() const;

  // Current while this lives, on the thread that made it; then what was current before is so again.
  class Use {
   public:
    explicit Use(const GlContext& context);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    void* own_display_;
    void* display_;
    void* draw_;
    void* read_;
    void* context_;
  };

  // GL_VERSION and GL_RENDERER, as the driver words them.
  const std::string& version() const { return version_; }
  const std::string& renderer() const { return renderer_; }

 private:
  GlContext(void* display, void* context) : display_(display), context_(context) {}

  static Result<GlContext> on_display(void* display);
  void swap(GlContext& other) noexcept;

  void* display_;  // EGLDisplay; EGL keeps it for the life of the program
  void* context_;  // EGLContext; null after a move
  std::string version_;
  std::string renderer_;
};

}  // namespace fude
