// fathom-bench: prints the table of measures. A ratio that falls short of what the project aims at is marked "!".
#include "bench/measure.h"

#include <cstdio>

int main() {
    using namespace fathom::bench;
    std::printf("%s\n\n", machine().c_str());
    Table table;
    measure_interpreter(table);
    print(table);
    return 0;
}
