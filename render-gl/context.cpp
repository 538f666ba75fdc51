#include "render-gl/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <dlfcn.h>
#include <string_view>
#include <vector>

namespace fathom::gl {

struct Context::State {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    ~State() {
        if (display == EGL_NO_DISPLAY) return;
        if (eglGetCurrentContext() == context)
            eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
        // The display stays initialised: EGL hands the same one to every context of the process.
    }
};

namespace {

bool offers(EGLDisplay display, std::string_view extension) {
    const char *all = eglQueryString(display, EGL_EXTENSIONS);
    return all && std::string_view(all).find(extension) != std::string_view::npos;
}

// Devices first: a GPU's driver shows up there. Mesa's surfaceless platform chooses by itself,
// software included.
std::vector<EGLDisplay> displays() {
    std::vector<EGLDisplay> result;
    if (offers(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
        offers(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
        std::array<EGLDeviceEXT, 16> devices{};
        EGLint count = 0;
        if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count)) {
            for (EGLint i = 0; i < count; ++i) {
                const char *extensions =
                    eglQueryDeviceStringEXT(devices[static_cast<std::size_t>(i)], EGL_EXTENSIONS);
                const bool software =
                    extensions && std::string_view(extensions).find("EGL_MESA_device_software") !=
                                      std::string_view::npos;
                if (software) continue;
                result.push_back(eglGetPlatformDisplayEXT(
                    EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr));
            }
        }
    }
    if (offers(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        result.push_back(
            eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
    return result;
}

EGLContext core_context(EGLDisplay display) {
    constexpr std::array<std::pair<int, int>, 6> versions{
        {{4, 6}, {4, 5}, {4, 3}, {4, 2}, {4, 0}, {3, 3}}};
    for (const auto &[major, minor] : versions) {
        const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 major,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 minor,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
        const EGLContext context =
            eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
        if (context != EGL_NO_CONTEXT) return context;
    }
    return EGL_NO_CONTEXT;
}

} // namespace

std::variant<Context, std::string> Context::make() {
    if (!eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS))
        return "this machine's EGL offers no displays without a window";
    std::string reason = "EGL finds no device and no surfaceless platform to draw on";
    for (EGLDisplay display : displays()) {
        if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) {
            reason = "EGL finds a device but cannot use it";
            continue;
        }
        if (!offers(display, "EGL_KHR_no_config_context") ||
            !offers(display, "EGL_KHR_surfaceless_context")) {
            reason = "EGL cannot draw without a window here";
            continue;
        }
        if (!eglBindAPI(EGL_OPENGL_API)) {
            reason = "EGL offers no desktop OpenGL here";
            continue;
        }
        auto state = std::make_unique<State>();
        state->display = display;
        state->context = core_context(display);
        if (state->context == EGL_NO_CONTEXT ||
            !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, state->context)) {
            reason = "there is no OpenGL 3.3 here";
            continue;
        }
        return Context(std::move(state));
    }
    return reason;
}

std::string Context::describe() const {
    const auto text = [](GLenum what) {
        const GLubyte *name = glGetString(what);
        return std::string(name ? reinterpret_cast<const char *>(name) : "unknown");
    };
    return text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

int Context::version() const { return epoxy_gl_version(); }

bool Context::make_current() const {
    return eglGetCurrentContext() == state_->context ||
           (eglBindAPI(EGL_OPENGL_API) &&
            eglMakeCurrent(state_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, state_->context));
}

// What a program has of GLX it has loaded itself: it is looked for, and not loaded here.
bool any_is_current() {
    if (eglGetCurrentContext() != EGL_NO_CONTEXT) return true;
    for (const char *name : {"libGLX.so.0", "libGL.so.1"}) {
        void *library = dlopen(name, RTLD_LAZY | RTLD_NOLOAD);
        if (!library) continue;
        const auto current = reinterpret_cast<void *(*)()>(dlsym(library, "glXGetCurrentContext"));
        const bool any = current && current();
        dlclose(library);
        if (any) return true;
    }
    return false;
}

KeptCurrent::KeptCurrent()
    : display_(eglGetCurrentDisplay()), context_(eglGetCurrentContext()),
      draw_(eglGetCurrentSurface(EGL_DRAW)), read_(eglGetCurrentSurface(EGL_READ)) {}

KeptCurrent::~KeptCurrent() {
    if (eglGetCurrentContext() == context_) return;
    if (context_ == EGL_NO_CONTEXT)
        eglMakeCurrent(eglGetCurrentDisplay(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    else
        eglMakeCurrent(display_, draw_, read_, context_);
}

Context::Context(std::unique_ptr<State> state) : state_(std::move(state)) {}
Context::Context(Context &&) noexcept = default;
Context &Context::operator=(Context &&) noexcept = default;
Context::~Context() = default;

} // namespace fathom::gl
