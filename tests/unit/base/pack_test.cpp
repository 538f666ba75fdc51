// What a page carries: known answers of the standards.
#include "base/pack.h"

#include <catch2/catch.hpp>

using namespace fathom;

TEST_CASE("base64 has the answers of RFC 4648") {
    CHECK(base64("").empty());
    CHECK(base64("f") == "Zg==");
    CHECK(base64("fo") == "Zm8=");
    CHECK(base64("foo") == "Zm9v");
    CHECK(base64("foobar") == "Zm9vYmFy");
    CHECK(base64("\xff\xfe") == "//4=");
}
