// Run twice: of this system, and of the fallback for others.
#include "system/system.h"

#include <catch2/catch.hpp>

#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace {

namespace system = fathom::system;

bool stays_here(int descriptor) { return (::fcntl(descriptor, F_GETFD) & FD_CLOEXEC) != 0; }

// Whether what is written at one end is read at the other.
bool goes_through(int from, int to) {
    char read = 0;
    return ::write(from, "x", 1) == 1 && ::read(to, &read, 1) == 1 && read == 'x';
}

} // namespace

TEST_CASE("descriptors work, and no other program gets them") {
    std::array<int, 2> pipe{-1, -1}, sockets{-1, -1};
    REQUIRE(system::open_pipe(pipe));
    REQUIRE(system::open_socket_pair(sockets));
    CHECK(goes_through(pipe[1], pipe[0]));
    CHECK(goes_through(sockets[0], sockets[1]));
    CHECK(goes_through(sockets[1], sockets[0]));
    CHECK(system::is_of_this_user(sockets[0]));
    for (const auto &ends : {pipe, sockets})
        for (const int end : ends) {
            CHECK(stays_here(end));
            ::close(end);
        }
}

TEST_CASE("a socket is listened to") {
    char folder[] = "/tmp/fathom-test-XXXXXX";
    REQUIRE(::mkdtemp(folder));
    const std::string path = std::string(folder) + "/socket";
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strcpy(address.sun_path, path.c_str());
    const auto *named = reinterpret_cast<sockaddr *>(&address);
    const int listening = system::open_socket(), caller = system::open_socket();
    REQUIRE(::bind(listening, named, sizeof address) == 0);
    REQUIRE(::listen(listening, 1) == 0);
    REQUIRE(::connect(caller, named, sizeof address) == 0);
    const int heard = system::accept_connection(listening);
    REQUIRE(heard >= 0);
    CHECK(goes_through(caller, heard));
    CHECK(system::is_of_this_user(heard));
    for (const int descriptor : {listening, caller, heard}) {
        CHECK(stays_here(descriptor));
        ::close(descriptor);
    }
    std::filesystem::remove_all(folder);
    CHECK(system::accept_connection(-1) < 0);
}

TEST_CASE("a file in memory is read and written") {
    const int file = system::open_memory();
    REQUIRE(file >= 0);
    CHECK(stays_here(file));
    REQUIRE(::write(file, "words", 5) == 5);
    char read[6] = "";
    CHECK(::pread(file, read, 5, 0) == 5);
    CHECK(std::string(read) == "words");
    ::close(file);
}

TEST_CASE("the own program is a file, or a name to be looked for") {
    const std::string program = system::own_program();
    CHECK((program == "fathom" || std::filesystem::equivalent(program, "/proc/self/exe")));
}
