#include "app/studio/sheet_image.h"

#include <epoxy/gl.h>

#include <utility>
#include <vector>

namespace fude {

SheetImage::SheetImage(int columns, int rows, Palette palette)
    : palette_(std::move(palette)), picture_(columns, rows) {
  const std::vector<Concentrations> bare(static_cast<std::size_t>(columns));
  for (int y = 0; y < rows; ++y) colour_row(bare, palette_, picture_.row(y));
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB16, columns, rows, 0, GL_RGB, GL_UNSIGNED_SHORT,
               picture_.pixels.data());
  sharpen(false);
}

SheetImage::~SheetImage() { glDeleteTextures(1, &texture_); }

void SheetImage::show(const InkRegion& region) {
  const CellRect& rect = region.rect;
  if (rect.columns <= 0 || rect.rows <= 0) return;
  const auto columns = static_cast<std::size_t>(rect.columns);
  for (int y = 0; y < rect.rows; ++y)
    colour_row(std::span(region.pigment).subspan(static_cast<std::size_t>(y) * columns, columns), palette_,
               picture_.row(picture_.height - 1 - (rect.bottom + y))
                   .subspan(static_cast<std::size_t>(rect.left), columns));
  const int top = picture_.height - rect.bottom - rect.rows;
  glBindTexture(GL_TEXTURE_2D, texture_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, picture_.width);
  glTexSubImage2D(GL_TEXTURE_2D, 0, rect.left, top, rect.columns, rect.rows, GL_RGB, GL_UNSIGNED_SHORT,
                  picture_.row(top).data() + rect.left);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

void SheetImage::sharpen(bool cells_are_large) const {
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, cells_are_large ? GL_NEAREST : GL_LINEAR);
}

}  // namespace fude
