// OpenGL 3.3 core for the sources of the modules: a context without a display, shader programs, errors.
#pragma once

#define GL_GLEXT_PROTOTYPES  // OSMesa and libOpenGL export the modern entry points themselves
#include <GL/glcorearb.h>

#include <initializer_list>
#include <memory>

#include "render/draw/geometry.hpp"
#include "render/mechanism/projection.hpp"

namespace beamcam::render {

inline constexpr const char* kRemedy = "choose the flat view: \"view\": {\"style\": \"flat\"}";

// A software context without a surface. Each module implements one.
class GlContext {
  public:
    GlContext() = default;
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;
    virtual ~GlContext() = default;
    virtual void make_current() = 0;  // on this thread; throws GlError
};
// Throws GlError if the library has no OpenGL 3.3 core.
std::unique_ptr<GlContext> make_context();

// Throws GlError with the driver's message.
GLuint link_program(std::initializer_list<const char*> vertex, std::initializer_list<const char*> fragment);

void set(GLuint program, const char* uniform, float value);
void set(GLuint program, const char* uniform, Vec2 value);
void set(GLuint program, const char* uniform, Vec3 value);

// Describes the bound vertex buffer: attributes 0, 1 … with these numbers of floats, interleaved.
void describe_vertices(std::initializer_list<GLint> floats);

// Creates and binds a frame buffer of RGBA pixels. Throws as the next two.
GLuint make_target(int width, int height);
void require_no_error();  // throws GlError, std::bad_alloc
void require_target();    // throws unless the bound frame buffer is complete

}  // namespace beamcam::render
