$# Ints of 32 bits that saturate (ir/semantics.h). Sums, products and negations wrap before they are
$# looked at; no division is by 0, and none by -1, which could overflow.

$helper fathom_add:int
int fathom_add(int x, int y) {
    int sum = x + y;
    bool above = y > 0 && sum < x;
    bool below = y < 0 && sum > x;
    if (above) sum = 2147483647;
    if (below) sum = -2147483647 - 1;
    return sum;
}

$helper fathom_sub:int
int fathom_sub(int x, int y) {
    int difference = x - y;
    bool above = y < 0 && difference < x;
    bool below = y > 0 && difference > x;
    if (above) difference = 2147483647;
    if (below) difference = -2147483647 - 1;
    return difference;
}

$helper fathom_mul:int
int fathom_mul(int x, int y) {
    bool negative = (x < 0) != (y < 0);
    uint a = uint(x);
    if (x < 0) a = uint(-x);
    uint b = uint(y);
    if (y < 0) b = uint(-y);
    uint most = 2147483647u + uint(negative);
    bool beyond = b != 0u && a > most / max(b, 1u);
    int product = int(a * b);
    if (negative) product = -product;
    if (beyond) product = 2147483647;
    if (beyond && negative) product = -2147483647 - 1;
    return product;
}

$helper fathom_neg:int
int fathom_neg(int x) {
    int negated = -x;
    if (x == -2147483647 - 1) negated = 2147483647;
    return negated;
}

$helper fathom_div needs fathom_neg:int
int fathom_div(int x, int y) {
    int divisor = 1;
    if (y != 0 && y != -1) divisor = y;
    int quotient = x / divisor;
    if (y == 0) quotient = 0;
    if (y == -1) quotient = fathom_neg(x);
    return quotient;
}

$helper fathom_abs:int needs fathom_neg:int
int fathom_abs(int x) {
    int size = x;
    if (x < 0) size = fathom_neg(x);
    return size;
}

$helper fathom_mod:int needs fathom_div
int fathom_mod(int x, int y) {
    int divisor = 1;
    if (y != 0 && y != -1) divisor = y;
    int rest = x - divisor * (x / divisor);
    if (rest != 0 && (rest < 0) != (y < 0)) rest += y;
    if (y == 0) rest = x;
    return rest;
}

$helper fathom_int
int fathom_int(float x) {
    int whole = 0;
    if (abs(x) < 2147483648.0) whole = int(x);
    if (x >= 2147483648.0) whole = 2147483647;
    if (x <= -2147483648.0) whole = -2147483647 - 1;
    return whole;
}
