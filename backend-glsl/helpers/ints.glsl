$# Ints of 32 bits that saturate (ir/semantics.h).

$helper fathom_add:int
int fathom_add(int x, int y) {
    int sum = x + y;
    if (y > 0 && sum < x) return 2147483647;
    return y < 0 && sum > x ? -2147483647 - 1 : sum;
}

$helper fathom_sub:int
int fathom_sub(int x, int y) {
    int difference = x - y;
    if (y < 0 && difference < x) return 2147483647;
    return y > 0 && difference > x ? -2147483647 - 1 : difference;
}

$helper fathom_mul:int
int fathom_mul(int x, int y) {
    int least = -2147483647 - 1;
    bool negative = (x < 0) != (y < 0);
    uint a = uint(x < 0 ? -x : x);
    uint b = uint(y < 0 ? -y : y);
    uint most = negative ? 2147483648u : 2147483647u;
    if (b != 0u && a > most / b) return negative ? least : 2147483647;
    uint product = a * b;
    return negative ? (product == 2147483648u ? least : -int(product)) : int(product);
}

$helper fathom_neg:int
int fathom_neg(int x) {
    return x == -2147483647 - 1 ? 2147483647 : -x;
}

$helper fathom_div
int fathom_div(int x, int y) {
    if (y == 0) return 0;
    return y == -1 ? (x == -2147483647 - 1 ? 2147483647 : -x) : x / y;
}

$helper fathom_abs:int needs fathom_neg:int
int fathom_abs(int x) {
    return x < 0 ? fathom_neg(x) : x;
}

$helper fathom_mod:int needs fathom_div
int fathom_mod(int x, int y) {
    if (y == 0 || y == -1) return y == 0 ? x : 0;
    int rest = x - y * (x / y);
    return rest != 0 && (rest < 0) != (y < 0) ? rest + y : rest;
}

$helper fathom_int
int fathom_int(float x) {
    if (x >= 2147483648.0) return 2147483647;
    if (x <= -2147483648.0) return -2147483647 - 1;
    return x == x ? int(x) : 0;
}
