"""Work in a separate process, which may die without taking anything along.

A child is such a process as its parent sees it: requests with a time limit, and an error at once
when it ends. It is forked, within milliseconds, from a process that has loaded libraries and has
one thread, unlike the process that asks for children. A guard between them holds one end of a pipe:
it writes the status of a child that has ended, and kills one that does not end soon after the pipe
was closed. So no child outlives the process that requested it, however that ends.
"""
