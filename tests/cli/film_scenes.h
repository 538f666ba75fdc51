// Scenes for films, and the program run on them by the CPU.
#pragma once

#include "shell.h"

// A scene whose every part moves or has an edge, beside quiet ones.
struct FilmScenes : ScratchFolder {
    FilmScenes() {
        write("ball.sdf",
              "param size = 1.0 in 0.5..2.0\n"
              "param count = 3 in 1..6\n"
              "sphere(size).translate(y: keyframes([[0, 0], [2, 1.5]], time))\n"
              "for i in 0..count { box(0.3).rotate(40deg, axis: Z).translate(x: i - 2) }\n"
              "box([3, 0.4, 1]).twist(time, axis: X).translate(y: -1.5).paint(tomato)\n"
              "camera(at: [0, 1, 6 + time], look_at: [0, 0, 0])\nrender(time: 10)\n");
        write("still.sdf", "sphere(1)\ncamera(at: [0, 0, 5])\n");
    }
    Result render(const std::string &words) const {
        return shell(*this, "fathom render ball.sdf --backend cpu " + words);
    }
};

inline const std::string sized = " --size 40x31 ";
