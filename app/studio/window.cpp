#include "app/studio/window.h"

#include <epoxy/gl.h>
// After epoxy, which stands in for the GL headers.
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui/backends/imgui_impl_glfw.h>
#include <imgui/backends/imgui_impl_opengl3.h>

namespace fude {
namespace {

constexpr double frame_s = 1.0 / 60;

Window& window_of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

std::string glfw_says() {
  const char* why = nullptr;
  glfwGetError(&why);
  return why ? std::string(" (") + why + ")" : std::string();
}

}  // namespace

Result<std::unique_ptr<Window>> Window::open(const std::string& title, WindowEvents events) {
  if (!glfwInit())
    return failure(Fault::unsupported,
                   "no display for a window" + glfw_says() + ": paint a session with 'fude replay'");
  std::unique_ptr<Window> window(new Window(std::move(events)));
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  window->window_ = glfwCreateWindow(1280, 900, title.c_str(), nullptr, nullptr);
  if (!window->window_)
    return failure(Fault::unsupported,
                   "no window with OpenGL 3.3 here" + glfw_says() + ": paint a session with 'fude replay'");
  glfwMakeContextCurrent(window->window_);
  glfwSwapInterval(0);  // the clock below waits; a hidden window would otherwise hold up the pen
  window->listen();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::StyleColorsLight();
  ImGui_ImplGlfw_InitForOpenGL(window->window_, true);
  ImGui_ImplOpenGL3_Init("#version 330");
  return window;
}

Window::~Window() {
  if (window_) {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
  }
  glfwTerminate();
}

void Window::listen() {
  glfwSetWindowUserPointer(window_, this);
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
    Window& self = window_of(w);
    const Eigen::Vector2d at(x, y);
    if (self.dragging_) self.events_.dragged(at - self.last_);
    self.last_ = at;
    if (!ImGui::GetIO().WantCaptureMouse && !self.dragging_) self.events_.moved(at);
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int) {
    Window& self = window_of(w);
    const bool pressed = action == GLFW_PRESS;
    if (button == GLFW_MOUSE_BUTTON_MIDDLE) self.dragging_ = pressed && !ImGui::GetIO().WantCaptureMouse;
    if (button == GLFW_MOUSE_BUTTON_LEFT && (!pressed || !ImGui::GetIO().WantCaptureMouse))
      self.events_.button(pressed);
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double notches) {
    Window& self = window_of(w);
    if (!ImGui::GetIO().WantCaptureMouse) self.events_.scrolled(notches, self.last_);
  });
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int mods) {
    if (action == GLFW_RELEASE || key < GLFW_KEY_A || key > GLFW_KEY_Z) return;
    std::string name(1, static_cast<char>('A' + (key - GLFW_KEY_A)));
    if (mods & GLFW_MOD_CONTROL) name = "Ctrl+" + name;
    if (mods & GLFW_MOD_SHIFT) name = "Shift+" + name;
    window_of(w).events_.key(name);
  });
}

bool Window::begin_frame() {
  glfwWaitEventsTimeout(frame_s);
  if (glfwWindowShouldClose(window_)) return false;
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  glViewport(0, 0, width, height);
  glClearColor(0.42F, 0.40F, 0.37F, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  return true;
}

void Window::draw_frame() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Window::end_frame() { glfwSwapBuffers(window_); }

Picture Window::shown() const {
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  Picture picture(width, height);
  glReadBuffer(GL_BACK);
  glPixelStorei(GL_PACK_ALIGNMENT, 2);
  for (int y = 0; y < height; ++y)
    glReadPixels(0, height - 1 - y, width, 1, GL_RGB, GL_UNSIGNED_SHORT, picture.row(y).data());
  return picture;
}

Eigen::Vector2d Window::size() const {
  int width = 1;
  int height = 1;
  glfwGetWindowSize(window_, &width, &height);
  return {std::max(width, 1), std::max(height, 1)};
}

}  // namespace fude
