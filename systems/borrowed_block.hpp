#pragma once
// A binding of a uniform block that is somebody else's again once this scope ends.

#include <epoxy/gl.h>

namespace petrichor {

struct BorrowedBlock {
  explicit BorrowedBlock(GLuint binding) : binding_(binding) {
    GLint64 value = 0;
    GLint id = 0;
    glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, binding, &id);
    id_ = static_cast<GLuint>(id);
    glGetInteger64i_v(GL_UNIFORM_BUFFER_START, binding, &value);
    start_ = static_cast<GLintptr>(value);
    glGetInteger64i_v(GL_UNIFORM_BUFFER_SIZE, binding, &value);
    size_ = static_cast<GLsizeiptr>(value);
  }
  ~BorrowedBlock() {
    if (id_ && size_ > 0) {
      glBindBufferRange(GL_UNIFORM_BUFFER, binding_, id_, start_, size_);
    } else {
      glBindBufferBase(GL_UNIFORM_BUFFER, binding_, id_);
    }
  }
  GLuint binding_, id_ = 0;
  GLintptr start_ = 0;
  GLsizeiptr size_ = 0;
};

}  // namespace petrichor
