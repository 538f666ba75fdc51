# What `./fathom` and `./fathom-test` share: installs the Debian packages that are missing, configures, builds.
# Sourced, with $root set. Says what it does on standard error; standard output belongs to the program.

# To build and to run. Mesa draws without a graphics card and without a display.
build_packages="g++ cmake ninja-build ccache pkg-config libfmt-dev tao-pegtl-dev libcli11-dev libglfw3-dev libimgui-dev
libepoxy-dev libegl-dev libyaml-dev glslang-dev libglm-dev nlohmann-json3-dev libfast-float-dev spirv-tools libpng-dev libjpeg-dev libzip-dev libmeshoptimizer-dev libopenexr-dev libopenvdb-dev libboost-dev catch2 libegl1 libgl1-mesa-dri
pybind11-dev python3-dev"
# To test: a display of our own for the viewer, a second compiler for the fuzzers, a newer one with its own standard library
# for .ci/run (libc++ 14 lacks the algorithms on ranges), a browser and what drives it; programs that judge meshes and volumes.
test_packages="xvfb xauth xdotool clang lld clang-16 libc++-16-dev libc++abi-16-dev python3-numpy python3-pytest chromium nodejs
admesh libopenvdb-tools"

say() { printf '%s\n' "fathom: $*" >&2; }

# install_packages NAMES: what is not there yet, with apt.
install_packages() {
    if ! command -v dpkg-query >/dev/null; then
        say "this is no Debian; going on with what is installed (wanted: Debian 12's $(echo $*))"
        return 0
    fi
    missing=""
    for package in $*; do
        dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing="$missing $package"
    done
    [ -z "$missing" ] && return 0
    as_root=""
    if [ "$(id -u)" != 0 ]; then
        if ! command -v sudo >/dev/null; then
            say "these packages are missing, and there is no sudo to install them:$missing"
            return 1
        fi
        as_root="sudo"
    fi
    say "installing with apt${as_root:+ (by sudo)}:$missing"
    $as_root apt-get update -qq >&2 || say "apt-get update failed; trying with the lists that are there"
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >&2 || {
        say "apt could not install them"
        return 1
    }
}

# Khronos' gltf-validator is no Debian package: where npm leaves it, so that node can load it from there.
gltf_validator="$root/build/npm"
fetch_gltf_validator() {
    [ -d "$gltf_validator/node_modules/gltf-validator" ] && return 0
    command -v npm >/dev/null || install_packages npm || return 1
    mkdir -p "$gltf_validator" &&
        timeout 120 npm install --prefix "$gltf_validator" --no-audit --no-fund --silent gltf-validator@2.0.0-dev.3.10 >&2
}

# use_ccache: what is configured from here on compiles through ccache, where there is one.
use_ccache() {
    command -v ccache >/dev/null && export CMAKE_CXX_COMPILER_LAUNCHER=ccache
    return 0
}

# changed_since STAMP: did a source, or a folder's list of files, change after it?
changed_since() {
    [ -e "$1" ] || return 0
    [ -n "$(find "$root" -path "$root/build*" -prune -o -path "$root/.git" -prune -o -newer "$1" \
        \( -name '*.cpp' -o -name '*.h' -o -name '*.def' -o -name '*.sdf' -o -name '*.glsl' -o -name '*.md' \
        -o -name '*.cmake' -o -name CMakeLists.txt -o -type d ! -path "$root" \) -print -quit)" ]
}

# build WHAT: configures where that was not done yet, and builds; a second call at the same time waits for the first.
build() {
    mkdir -p "$root/build" || return 1
    exec 9>"$root/build/.lock"
    flock 9
    touch "$root/build/.started"
    if [ ! -e "$root/build/build.ninja" ]; then
        say "configuring (into build/)"
        use_ccache
        cmake -G Ninja -S "$root" -B "$root/build" -DCMAKE_UNITY_BUILD=ON >"$root/build/configure.log" 2>&1 || {
            cat "$root/build/configure.log" >&2
            rm -f "$root/build/build.ninja"
            return 1
        }
    fi
    if [ -t 2 ]; then
        ninja -C "$root/build" "$@" >&2
    else
        # no terminal: a line for each tenth that is done, and the rest in a log
        { ninja -C "$root/build" "$@" 2>&1; echo $? >"$root/build/.status"; } | tee "$root/build/build.log" |
            while IFS= read -r line; do # ninja's "[12/345] …"
                case $line in "["*/*"]"*) ;; *) continue ;; esac
                all=${line#*/} all=${all%%]*} made=${line#[} made=${made%%/*}
                [ $((10 * made / all)) -gt "${said:-0}" ] || continue
                said=$((10 * made / all))
                say "built $made of $all"
            done
        [ "$(cat "$root/build/.status")" = 0 ] || {
            tail -n 60 "$root/build/build.log" >&2
            return 1
        }
    fi || return 1
    exec 9>&-
}
