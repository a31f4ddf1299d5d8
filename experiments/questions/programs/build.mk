# Eight small programs of C, compiled: something for `make -j2`.
objects := $(foreach number,1 2 3 4 5 6 7 8,part$(number).o)

.PHONY: all
all: $(objects)

%.o:
	echo '#include <stdio.h>' > $*.c
	for n in $$(seq 40); do echo "double f$$n(double x) { for (int i = 0; i < $$n; ++i) x = x * 0.5 + i; printf(\"%g\", x); return x; }" >> $*.c; done
	$(CC) -O2 -c $*.c -o $@
