// The program: arguments in, exit code out.
int main() { return 0; }
