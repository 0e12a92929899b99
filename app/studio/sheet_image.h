// The sheet as the window shows it: a 16-bit picture and its texture, brought up to date where ink changed.
// For the thread whose OpenGL context is current.
#pragma once

#include "sim/ink/ink.h"
#include "sim/optics/colour.h"
#include "sim/optics/picture.h"

namespace fude {

class SheetImage {
 public:
  // A blank sheet of columns × rows cells.
  SheetImage(int columns, int rows, Palette palette);
  ~SheetImage();
  SheetImage(const SheetImage&) = delete;
  SheetImage& operator=(const SheetImage&) = delete;

  void show(const InkRegion& region);

  // GL_NEAREST or GL_LINEAR as one cell covers more or less than a pixel.
  void sharpen(bool cells_are_large) const;

  unsigned texture() const { return texture_; }
  const Picture& picture() const { return picture_; }

 private:
  Palette palette_;
  Picture picture_;
  unsigned texture_ = 0;
};

}  // namespace fude
