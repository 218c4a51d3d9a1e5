#include "render/gl/module/opengl.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <new>
#include <numeric>

#include "render/base/error.hpp"

namespace beamcam::render {
namespace {

GLuint compile(GLenum kind, std::initializer_list<const char*> parts) {
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, static_cast<GLsizei>(parts.size()), parts.begin(), nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (!good) {
        std::array<char, 2048> log{};
        glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
        throw GlError(fmt::format("the OpenGL driver rejected a shader ({}); {}", log.data(), kRemedy));
    }
    return shader;
}

}  // namespace

GLuint link_program(std::initializer_list<const char*> vertex, std::initializer_list<const char*> fragment) {
    const GLuint program = glCreateProgram(), v = compile(GL_VERTEX_SHADER, vertex),
                 f = compile(GL_FRAGMENT_SHADER, fragment);
    glAttachShader(program, v);
    glAttachShader(program, f);
    glLinkProgram(program);
    glDeleteShader(v);
    glDeleteShader(f);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (!good) throw GlError(fmt::format("the OpenGL driver could not link a program; {}", kRemedy));
    return program;
}

void set(GLuint program, const char* uniform, float value) {
    glUniform1f(glGetUniformLocation(program, uniform), value);
}
void set(GLuint program, const char* uniform, Vec2 value) {
    glUniform2f(glGetUniformLocation(program, uniform), float(value.x), float(value.y));
}
void set(GLuint program, const char* uniform, Vec3 value) {
    glUniform3f(glGetUniformLocation(program, uniform), float(value.x), float(value.y), float(value.z));
}

void describe_vertices(std::initializer_list<GLint> floats) {
    const auto stride = static_cast<GLsizei>(sizeof(float)) * std::accumulate(floats.begin(), floats.end(), 0);
    std::size_t offset = 0;
    GLuint attribute = 0;
    for (const GLint count : floats) {
        glEnableVertexAttribArray(attribute);
        glVertexAttribPointer(
            attribute, count, GL_FLOAT, GL_FALSE, stride,
            reinterpret_cast<const void*>(offset));  // NOLINT(performance-no-int-to-ptr): required by OpenGL
        offset += sizeof(float) * static_cast<std::size_t>(count);
        ++attribute;
    }
}

GLuint make_target(int width, int height) {
    GLuint pixels = 0, target = 0;
    glGenRenderbuffers(1, &pixels);
    glGenFramebuffers(1, &target);
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glBindRenderbuffer(GL_RENDERBUFFER, pixels);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, pixels);
    require_target();
    return target;
}

void require_no_error() {
    const GLenum error = glGetError();
    if (error == GL_OUT_OF_MEMORY) throw std::bad_alloc();
    if (error != GL_NO_ERROR)
        throw GlError(fmt::format("OpenGL reported error 0x{:x} while drawing; {}", error, kRemedy));
}

void require_target() {
    require_no_error();  // reports a failed allocation
    if (const GLenum state = glCheckFramebufferStatus(GL_FRAMEBUFFER); state != GL_FRAMEBUFFER_COMPLETE)
        throw GlError(fmt::format("OpenGL cannot draw into its own memory here (0x{:x}); {}", state, kRemedy));
}

}  // namespace beamcam::render
