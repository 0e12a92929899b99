// A window with OpenGL 3.3 and Dear ImGui, and what the mouse and the keyboard do in it.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>

#include "signal/result.h"
#include "sim/optics/picture.h"

struct GLFWwindow;

namespace fude {

// Places and motions in pixels of the window, y downwards. Nothing comes while a panel has the mouse.
struct WindowEvents {
  std::function<void(const Eigen::Vector2d& at)> moved;
  std::function<void(bool pressed)> button;
  std::function<void(const Eigen::Vector2d& by)> dragged;  // with the middle button
  std::function<void(double notches, const Eigen::Vector2d& at)> scrolled;
  std::function<void(const std::string& key)> key;  // "Z", with "Shift+" and "Ctrl+" before it
};

class Window {
 public:
  // Errors: unsupported, where there is no display or no OpenGL.
  static Result<std::unique_ptr<Window>> open(const std::string& title, WindowEvents events);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  // Waits for the next frame's time, calls the events, clears and begins a frame; false when it was closed.
  bool begin_frame();
  void draw_frame();
  void end_frame();
  Eigen::Vector2d size() const;
  // What the frame shows, between drawing and ending it.
  Picture shown() const;

 private:
  explicit Window(WindowEvents events) : events_(std::move(events)) {}
  void listen();

  WindowEvents events_;
  GLFWwindow* window_ = nullptr;
  Eigen::Vector2d last_ = Eigen::Vector2d::Zero();
  bool dragging_ = false;
};

}  // namespace fude
