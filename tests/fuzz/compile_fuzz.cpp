// libFuzzer target of the whole front end, up to the emitted shader: any bytes are answered with a
// report that prints, or with a shader that glslang accepts.
#include "support/whole.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const fathom::test::Answer answer =
        fathom::test::whole_compiler(std::string(reinterpret_cast<const char *>(data), size));
    if (answer.fault.empty()) return 0;
    std::fprintf(stderr, "compile_fuzz: %s\n", answer.fault.c_str());
    std::abort();
}
