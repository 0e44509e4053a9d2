// Built from client/src by client/build.js; change that instead.
/*! Holds parts of gl-matrix, of which this is the licence:

Copyright (c) 2015-2025, Brandon Jones, Colin MacKenzie IV.

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in
all copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN
THE SOFTWARE. */
/*! Holds parts of zarrita, of which this is the licence:

MIT License

Copyright (c) 2020-2023 Trevor Manz

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all
copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE. */
function za(a){let e=a>>10&31,t=a&1023,r;return e===0?r=t*2**-24:e===31?r=t?NaN:1/0:r=(1024+t)*2**(e-25),a&32768?-r:r}var Le=Float32Array.
from({length:65536},(a,e)=>za(e)),Yr=new Float32Array(1),Xr=new Uint32Array(Yr.buffer);function qr(a){Yr[0]=a;let e=Xr[0]>>>
16&32768,t=Xr[0]&2147483647;return t>=1199566848?e|(t>2139095040?32256:31744):t<947912704?e|Math.round(Math.abs(a)*2**24):
e|t-93952e4>>>13}function lr(a,e,t,r=1){let n=a.getParameter(a.MAX_TEXTURE_SIZE),s=a.getParameter(a.MAX_ARRAY_TEXTURE_LAYERS);
if(Math.max(e,t)>n||r>s)throw new Error(`a texture of ${e} x ${t} texels in ${r} layers is needed, but this graphics car\
d supports at most ${n} x ${n} in ${s}; show fewer nodes`)}function et(a,e,t){let{width:r,height:n,layers:s,channels:o,levels:i}=t;
lr(a,r,n,s);let c=a.TEXTURE_2D_ARRAY;a.bindTexture(c,e),a.texStorage3D(c,i+1,o===1?a.R16F:a.RGBA16F,r,n,s),a.texParameteri(
c,a.TEXTURE_MIN_FILTER,a.LINEAR_MIPMAP_LINEAR),a.texParameteri(c,a.TEXTURE_MAG_FILTER,a.LINEAR),a.texParameteri(c,a.TEXTURE_WRAP_S,
a.CLAMP_TO_EDGE),a.texParameteri(c,a.TEXTURE_WRAP_T,a.CLAMP_TO_EDGE)}var Zr=["coastlines","graticule"],Me={critical:"critical_points",separatrices:"separatrices",nullclines:"nullclines"},tt={
saddle:8,orbit:4,leaving:2},Kr={float32:Float32Array,uint32:Uint32Array,float16:Uint16Array,uint16:Uint16Array,int16:Int16Array,
int8:Int8Array,uint8:Uint8Array};function hr({low:a,high:e,log:t}){if(!t)return n=>(n-a)/(e-a||1);let r=Math.log(e/a)||1;
return n=>Math.log(Math.max(n,a)/a)/r}function me(a){return a.variant.includes("FLOWTEX_SIGNFREE")}function Y(a){return Number(a.split("/")[1])}function Ee(a,e,{
scalars:t}){let[r,n,s="0"]=a.split("/"),o=t.choices[Number(s)]?.steps??t.steps;return r==="scalars"&&Number(n)===e&&o>1}
function pe(a){let[e,t,r,n,...s]=a.split("/");return e==="tile"?[[t,r,n].join("/"),s.join("/")]:null}function Qr(a,e){let t=ArrayBuffer.
isView(e)?new Uint8Array(e.buffer,e.byteOffset,e.byteLength):new Uint8Array(e),{name:r,dtype:n,shape:s,digest:o}=a,i=Kr[n];
if(!i)throw new Error(`a part has the type "${n}"; expected ${Object.keys(Kr).join(", ")}`);return{name:r,shape:s,digest:o,
data:new i(t.slice().buffer)}}function en(a){let[e,t]=ur(new Uint8Array(a)),r=t;return e.map(n=>{let s=new Uint8Array(a,
r,n.bytes);return r+=n.bytes,n.differences===void 0?Qr(n,s):rn(n,s)})}function ur(a){let e=4+new DataView(a.buffer,a.byteOffset).
getUint32(0,!0);return[JSON.parse(new TextDecoder().decode(a.subarray(4,e))),e]}async function tn(a,e){return rn(a,new Uint8Array(
await Ga(e).arrayBuffer()))}function Ga(a){let e=atob(a),t=new Uint8Array(e.length);for(let r=0;r<t.length;r+=1)t[r]=e.charCodeAt(
r);return new Response(new Blob([t]).stream().pipeThrough(new DecompressionStream("gzip")))}var Jr={1:Uint8Array,2:Uint16Array,
4:Uint32Array};function rn(a,e){let{shape:t,differences:r=[0,0],scale:n=null}=a,s=t.reduce((u,m)=>u*m,1),o=s?e.length/s:
1;if(!(o in Jr))throw new Error(`the packing of the part "${a.name}" is invalid`);let[i,c]=t.length>2?t.slice(-2):[...t,
1].slice(-2),l=new Jr[o](s);for(let u=0,m=0;u<c;u+=1)for(let p=u;p<s;p+=c,m+=1){let f=0;for(let d=0;d<o;d+=1)f|=e[d*s+m]<<
8*d;l[p]=f>>>1^-(f&1)}let h=i*c;for(let u=0;u<r[0];u+=1)for(let m=h;m<s;m+=1)l[m]+=l[m-h];for(let u=0;u<r[1];u+=1)for(let m=0;m<
s;m+=h)for(let p=m+c;p<m+h;p+=1)l[p]+=l[p-c];return Qr(a,n?Wa(l,n.map(u=>2**u)):l)}function Wa(a,e){let t=e.length;return a instanceof
Uint16Array?a.map((r,n)=>qr((r<<16>>16)*e[n%t])):new Float32Array(new Float64Array(a).map((r,n)=>(r|0)*e[n%t]))}var mr=1e-6,rt=typeof Float32Array<"u"?Float32Array:Array;var $c=Math.PI/180,jc=180/Math.PI;function sn(a,e){if(a===e){var t=e[1],r=e[2],n=e[5];a[1]=e[3],a[2]=e[6],a[3]=t,a[5]=e[7],a[6]=r,a[7]=n}else a[0]=e[0],a[1]=
e[3],a[2]=e[6],a[3]=e[1],a[4]=e[4],a[5]=e[7],a[6]=e[2],a[7]=e[5],a[8]=e[8];return a}function an(a,e,t){var r=t[0],n=t[1],s=t[2],o=Math.sqrt(r*r+n*n+s*s),i,c,l;return o<mr?null:(o=1/o,r*=o,n*=o,s*=o,i=Math.
sin(e),c=Math.cos(e),l=1-c,a[0]=r*r*l+c,a[1]=n*r*l+s*i,a[2]=s*r*l-n*i,a[3]=0,a[4]=r*n*l-s*i,a[5]=n*n*l+c,a[6]=s*n*l+r*i,
a[7]=0,a[8]=r*s*l+n*i,a[9]=n*s*l-r*i,a[10]=s*s*l+c,a[11]=0,a[12]=0,a[13]=0,a[14]=0,a[15]=1,a)}function Xa(){var a=new rt(3);return rt!=Float32Array&&(a[0]=0,a[1]=0,a[2]=0),a}function on(a){var e=a[0],t=a[1],r=a[2];return Math.sqrt(e*e+t*t+r*r)}function cn(a,e,t){return a[0]=e[0]-t[0],a[1]=e[1]-t[1],a[2]=e[2]-t[2],a}function ln(a,e,t){return a[0]=e[0]*t,a[1]=e[1]*t,a[2]=e[2]*t,a}function hn(a,e,t,r){return a[0]=e[0]+t[0]*r,a[1]=e[1]+t[1]*
r,a[2]=e[2]+t[2]*r,a}function un(a,e){var t=e[0],r=e[1],n=e[2],s=t*t+r*r+n*n;return s>0&&(s=1/Math.sqrt(s)),a[0]=e[0]*s,a[1]=e[1]*s,a[2]=e[2]*
s,a}function mn(a,e){return a[0]*e[0]+a[1]*e[1]+a[2]*e[2]}function pn(a,e,t){var r=e[0],n=e[1],s=e[2],o=t[0],i=t[1],c=t[2];
return a[0]=n*c-s*i,a[1]=s*o-r*c,a[2]=r*i-n*o,a}function fn(a,e,t){var r=e[0],n=e[1],s=e[2],o=t[3]*r+t[7]*n+t[11]*s+t[15];return o=o||1,a[0]=(t[0]*r+t[4]*n+t[8]*s+t[12])/
o,a[1]=(t[1]*r+t[5]*n+t[9]*s+t[13])/o,a[2]=(t[2]*r+t[6]*n+t[10]*s+t[14])/o,a}function pr(a,e,t){var r=e[0],n=e[1],s=e[2];
return a[0]=r*t[0]+n*t[3]+s*t[6],a[1]=r*t[1]+n*t[4]+s*t[7],a[2]=r*t[2]+n*t[5]+s*t[8],a}var qc=(function(){var a=Xa();return function(e,t,r,n,s,o){var i,c;for(t||(t=3),r||(r=0),n?c=Math.min(n*t+r,e.length):c=
e.length,i=r;i<c;i+=t)a[0]=e[i],a[1]=e[i+1],a[2]=e[i+2],s(a,a,o),e[i]=a[0],e[i+1]=a[1],e[i+2]=a[2];return e}})();var W=a=>a,re=()=>[0,0,0],dn=a=>new Array(a).fill(0),P=(a,e)=>mn(W(a),W(e)),F=a=>on(W(a)),E=(a,e)=>cn(re(),W(a),W(e)),k=(a,e)=>ln(
re(),W(a),e),N=(a,e)=>pn(re(),W(a),W(e)),V=a=>un(re(),W(a)),R=(a,e,t=1)=>hn(re(),W(a),W(e),t);function nt(a,e,t){let r=an(
dn(16),t*Math.PI/180,W(e));return r===null?re():fn(re(),W(a),r)}function O(a,e){let t=sn(dn(9),a);return pr(re(),W(e),t)}
function K(a,e){return pr(re(),W(e),a)}function T(a,e,t){return Math.min(Math.max(a,e),t)}var qa="own cmap";var gn=256;function Ka({scalars:a},e,t,r){let{entries:n,flip:s,maps:o}=a,i=r?r.slice():new Uint8Array(4*n).fill(255),c=i.
length/4-1||1;return i.map((l,h)=>{let[u,m]=[h>>2,h&3],p=Math.round((s?c-u:u)/c*(gn-1));return m===3?l:e[3*(o.indexOf(t)*
gn+p)+m]})}function bn(a,{beyond:e}){let t=a.length/4,r=a instanceof Float32Array;return Float32Array.from({length:a.length+
12},(n,s)=>{let[o,i]=[s>>2,s&3],c=a[4*T(o-1,0,t-1)+i];return i===3?r?o?c:1:0:(o>t?e[o-t]:o?null:e[0])?.[i]??c/255})}function yn(a,e,t){let r={...a.scalars};e.scalars===!1&&(r.name=null);let n=r.choices.findIndex(({name:b})=>b===e.scalars);
if(n>=0){let{name:b,label:y,unit:x,steps:v,flat:w}=r.choices[n];Object.assign(r,{name:b,label:y,unit:x,steps:v,flat:w,number:n,
auto:!0})}if(e.cmap&&(r.cmap=e.cmap),Array.isArray(e.clim)&&([r.low,r.high]=e.clim),e.clim!==void 0&&(r.auto=!e.clim),r.
auto&&r.choices[r.number]){let{cmap:b="",least:y,...x}=r.choices[r.number],v=r.log&&y>0,[w,M]=v?[y,x.most]:[x.low,x.high],
S=(w<0&&M>0||r.diverging.includes(b))&&r.diverging.includes(r.cmap),_=Math.max(-w,M);[r.low,r.high]=S?[-_,_]:[w,M]}let{coastlines:s=a.
earth?.coastlines,graticule:o=a.earth?.graticule}=e,i=a.earth&&{...a.earth,coastlines:s,graticule:o},{opacity:c=a.opacity}=e,
l={scalars:r,earth:i,opacity:c},[h,u]=[t.get("maps"),t.get("cmap")?.data],m=u instanceof Float32Array,p=m&&(e.clim!==void 0||
e.scalars!==void 0);if(!h||!(e.cmap||p))return{colours:l,part:null};p&&Object.assign(r,{ticks:[],beyond:[null,null,r.beyond[2]]});
let f=m&&!p,d=e.cmap?Ka(a,h.data,e.cmap,f?u:void 0):Uint8Array.from(u??[]),g=[qa,e.cmap,f].join();return{colours:l,part:{
name:"cmap",data:d,shape:[d.length/4,4],digest:g}}}var fr=[0,0,1],xn=Math.sin(89*Math.PI/180),Ja=.2;var fe=a=>Math.tan(a*Math.PI/360),de=class{flat;limits;aspect;state;start;pick=null;globe;homeHeight;nearest;constructor(e,t,r,n=1,s=0){
this.state=dr(e),this.start=dr(e),this.limits=t,this.flat=r,this.globe=s,this.aspect=n,this.homeHeight=this.height,this.
nearest=this.distance/t.closest}get height(){let{parallel:e,parallel_scale:t,view_angle:r}=this.state;return e?t:this.distance*
fe(r)}get distance(){return F(E(this.state.focal_point,this.state.position))}get zoom(){return this.homeHeight/this.height}get axes(){
let e=V(E(this.state.focal_point,this.state.position)),t=V(N(e,this.state.up));return[t,N(t,e),e]}sight(e){let{parallel:t,
position:r,view_angle:n}=this.state;return t?{eye:null,halfHeight:this.height,pixels:e}:{eye:r,halfHeight:fe(n),pixels:e}}get planes(){
let[e,t,r]=this.axes,{parallel:n,parallel_scale:s,view_angle:o}=this.state,{position:i,focal_point:c}=this.state,l=n?s:fe(
o);return[e,k(e,-1),t,k(t,-1)].map((h,u)=>{let m=u<2?l*this.aspect:l;if(n)return[...h,m-P(h,c)];let p=R(h,r,m);return[...p,
-P(p,i)]})}get eye(){return this.state.parallel?[...k(this.axes[2],-1),0]:[...this.state.position,1]}at(e){let t=this.axes[2];
if(this.state.parallel)return{height:this.height,ray:t};let r=E(e,this.state.position);return{height:P(r,t)*fe(this.state.
view_angle),ray:V(r)}}project(e){let[t,r]=this.axes,{height:n}=this.at(e);if(!(n>0))return null;let{parallel:s,position:o,
focal_point:i}=this.state,c=E(e,s?i:o);return[P(t,c)/n/this.aspect,P(r,c)/n]}pan(e,t){let[r,n]=this.axes,{height:s}=this;
this.shift(R(k(r,e*this.aspect*s),n,t*s))}rotate(e,t){if(this.globe)return this.roam(e,t);let{state:r,limits:n}=this,s=V(
r.up),o=E(r.position,r.focal_point);o=nt(o,s,-n.turn*e*Math.min(this.aspect,n.widest_turn));let i=V(N(s,o));o=nt(o,i,n.turn*
t),r.position=R(r.focal_point,o),r.up=V(N(o,i))}roam(e,t){let{state:r,limits:n,globe:s}=this,o=F(r.position),i=Math.max(
o-s,0)*fe(r.view_angle),c=r.parallel?r.parallel_scale:i,l=Math.min(c/s*180/Math.PI,n.turn),h=Math.hypot(r.position[0],r.
position[1])/o,u=Math.min(l*this.aspect/Math.max(h,Ja),n.turn);this.turn(fr,-u*e);let[m]=this.axes,p=Math.abs(r.position[2])/
o,f=dr(r);this.turn(m,l*t),Math.abs(r.position[2])/o>Math.max(xn,p)&&(this.state=f);let[,,g]=this.axes,b=R(fr,g,-P(fr,g));
F(b)>1-xn&&(this.state.up=V(b))}turn(e,t){let{state:r}=this;for(let n of["position","focal_point","up"])r[n]=nt(r[n],e,t)}zoomBy(e,t=0,r=0){
if(!Number.isFinite(e)||e<=0)return;this.flat||this.focusAt(t,r);let{farthest_zoom:n,deepest_zoom:s}=this.limits,o=T(e,n/
this.zoom,s/this.zoom),[i,c,l]=this.axes,h=this.height*(1-1/o);this.shift(R(k(i,t*this.aspect*h),c,r*h)),this.state.parallel?
this.state.parallel_scale/=o:this.approach(this.height/o,l)}ray(e,t){let[r,n,s]=this.axes,{height:o,state:i}=this,c=R(R(
i.focal_point,r,e*this.aspect*o),n,t*o);return i.parallel?[R(c,s,-this.distance),s]:[R(i.position,[0,0,0]),V(E(c,i.position))]}approach(e,t){
let r=Math.max(e/fe(this.limits.view_angle),this.nearest);this.state.position=R(this.state.focal_point,t,-r),this.state.
view_angle=Math.atan(e/r)*360/Math.PI}focusAt(e,t){let r=this.pick?.(e,t);if(!r)return;let n=this.axes[2],s=P(E(r,this.state.
position),n);s>0&&(this.state.focal_point=R(this.state.position,n,s))}shift(e){this.state.focal_point=R(this.state.focal_point,
e),this.state.position=R(this.state.position,e)}};function dr(a){let{position:e,focal_point:t,up:r}=a;return{...a,position:[
...e],focal_point:[...t],up:[...r]}}function z(a,e,t){let{state:r,aspect:n}=e,{center:s,extent:o,frame:i}=a,[c,l,h]=e.axes.map(S=>O(i,S)),u=S=>E(O(i,E(S,s)),
t),m=u(r.focal_point),p=k(t,-1),f=Math.max(.51*o,a.reach??0),d=new Array(16).fill(0),g=r.parallel?r.parallel_scale:fe(r.
view_angle);if([c.map(S=>S/g/n),l.map(S=>S/g)].forEach((S,_)=>{for(let L=0;L<3;L+=1)d[4*L+_]=S[L];d[12+_]=-P(S,m)}),r.parallel){
for(let S=0;S<3;S+=1)d[4*S+2]=h[S]/f;return d[14]=-P(h,p)/f,d[15]=1,d}let y=u(r.position),x=P(E(p,y),h),v=Math.max(x+f,.001*
f),w=Math.max(x-f,.001*v),M=(v+w)/(v-w),A=-2*v*w/(v-w);for(let S=0;S<3;S+=1)d[4*S+2]=h[S]*M,d[4*S+3]=h[S];return d[15]=-P(
h,y),d[14]=d[15]*M+A,d}function vn({center:a,frame:e},t,r,n,s){let[o,i]=t.axes,{height:c,state:l,aspect:h}=t,[u,m]=[k(o,
2*c*h/n),k(i,2*c/s)],p=R(R(E(l.focal_point,a),u,-n/2),m,-s/2);return{u_rayCorner:E(O(e,p),r),u_rayX:O(e,u),u_rayY:O(e,m)}}var oe=8,Mn=9,Za=.2,Qa=1.4,wn=55,eo=125,to=.5,ro=4,En=4e-5,Sn=2e-6;function Tn(a,e,t,r,n){let s=Math.max(n-e,Math.min(e/
2,n),2)/a;if(t*(r+oe)<=s)return{scale:1,samples:r};let o=Math.min(Mn,r),i=Math.sqrt(s/(o+oe)/t);return i<1?{scale:Math.max(
i,Za),samples:o}:{scale:1,samples:T(Math.floor(s/t-oe),o,r)}}function An(a,e,t,r,n){if(!n)return wn;let s=Math.min(Mn,r),
o=e+a*t*to**2*(s+oe);return T(o,wn,eo)}function _n(a,e,t,r){return Math.max(Math.floor(a/(e*t*(r+oe))),ro)}function Pn(a){
return(2*a+oe)/(a+oe)}function Rn(a,e,t,r,n){let s=Math.max(e,.05)/(t*(r+oe)*n);return a+(s-a)*(s>a?.7:.3)}function Ln(a,e,t){
let[r,n,s]=[a.grain,a.spacing,a.samples].map(Number),o=Math.max(r*t,Math.min(r,1)),c=s*n*r*t/(e*o);return{u_grain:o,u_spacing:T(
c,.1,Math.max(Qa,n))}}var no=`#version 300 es
precision highp float;
precision highp int;
`,so=["flowtexPosition","flowtexCoordinate","flowtexNormal","flowtexScalar","flowtexCorners","flowtexRadius"],Q=["u_slic\
es","u_slicesNext","u_image","u_stepImage","u_cmap","u_shares","u_along","u_nodes","u_corners","u_open","u_places","u_de\
pths","u_colours","u_strides","u_below","u_texture","u_source","u_means"],Se=class{graphics;entries=new Map;parallel=null;constructor(e){
this.graphics=e}findFeatures(){this.parallel=this.graphics.context.getExtension("KHR_parallel_shader_compile")}clear(){this.
entries.clear()}dispose(){for(let e of this.entries.values()){for(let t of e.shaders)this.graphics.free("Shader",t);this.
graphics.free("Program",e.program)}this.clear()}get(e,t,...r){let n=[e,t,...r].join("\0"),s=this.entries.get(n);return s||
this.entries.set(n,s=this.build(e,t,r)),!s.ready&&!s.error&&this.finish(s),s}build(e,t,r){let{graphics:n}=this,s=n.context,
o=n.counted(s.createProgram()),i=[s.VERTEX_SHADER,s.FRAGMENT_SHADER],c=no+r.map(u=>`#define ${u}
`).join(""),l=[e,t].map((u,m)=>{let p=n.counted(s.createShader(i[m]));return s.shaderSource(p,u.startsWith("#version")?u:
c+u),s.compileShader(p),s.attachShader(o,p),p});return so.forEach((u,m)=>s.bindAttribLocation(o,m,u)),s.linkProgram(o),{
program:o,shaders:l,uniforms:new Map,...{ready:!1,error:"",warm:!1,price:En}}}finish(e){let t=this.graphics.context,{program:r}=e,
n=this.parallel?.COMPLETION_STATUS_KHR;if(n&&!t.getProgramParameter(r,n))return;if(!t.getProgramParameter(r,t.LINK_STATUS)){
if(t.isContextLost())return;let i=[...e.shaders.map(c=>t.getShaderInfoLog(c)),t.getProgramInfoLog(r)].filter(Boolean).join(
`
`);e.error=i||"the driver gave no reason";return}for(let o of e.shaders)this.graphics.free("Shader",o);e.shaders=[];let s=t.
getProgramParameter(r,t.ACTIVE_UNIFORMS);for(let o=0;o<s;o+=1){let i=t.getActiveUniform(r,o),c=i&&t.getUniformLocation(r,
i.name);!i||!c||e.uniforms.set(i.name.replace(/\[0\]$/,""),{location:c,type:i.type})}t.useProgram(r),Q.forEach((o,i)=>{let c=e.
uniforms.get(o);c&&c.type!==t.FLOAT_VEC2&&t.uniform1i(c.location,i)}),e.ready=!0}use(e,t){let r=this.graphics.context;r.
useProgram(e.program);for(let[n,s]of Object.entries(t)){let o=e.uniforms.get(n);if(!o)continue;let{location:i,type:c}=o,
l=typeof s=="object"?s:[Number(s)];c===r.FLOAT?r.uniform1fv(i,l):c===r.FLOAT_VEC2?r.uniform2fv(i,l):c===r.FLOAT_VEC3?r.uniform3fv(
i,l):c===r.FLOAT_VEC4?r.uniform4fv(i,l):c===r.FLOAT_MAT4?r.uniformMatrix4fv(i,!1,l):c===r.INT_VEC2?r.uniform2iv(i,l):r.uniform1i(
i,l[0])}}};var ao=4,oo=45,io=[4,68],co=Symbol.for("flowtex.gl/3");function kn(a){return["EXT_color_buffer_float","EXT_color_buffer_\
half_float"].some(e=>a.getExtension(e)!==null)}var gr=class{canvas=document.createElement("canvas");gl;programs;users=new Set;waiting=new Set;common=new Map;stock=new Map;tracings=new Map;objects=0;isLost=!1;scheduled=0;picker=null;smooth=null;constructor(){
this.canvas.width=this.canvas.height=16;let e=this.canvas.getContext("webgl2",{alpha:!0,antialias:!1,powerPreference:"hi\
gh-performance"});this.gl=e&&kn(e)?e:null,this.programs=new Se(this),this.gl&&this.programs.findFeatures(),this.canvas.addEventListener(
"webglcontextlost",t=>{t.preventDefault(),this.isLost=!0,this.objects=0,this.programs.clear(),this.common.clear(),this.tracings.
clear(),this.picker=this.smooth=null;for(let r of this.users)r.lost()}),this.canvas.addEventListener("webglcontextrestor\
ed",()=>{this.isLost=!1,this.gl&&kn(this.gl)&&this.programs.findFeatures();for(let t of this.users)t.change()})}get context(){
if(!this.gl)throw new Error("WebGL2 is not available");return this.gl}leave(e){if(this.users.delete(e),this.waiting.delete(
e),!this.users.size){cancelAnimationFrame(this.scheduled),this.scheduled=0,this.programs.dispose();for(let t of[this.picker,
this.smooth])t&&this.freeTarget(t);this.picker=this.smooth=null,this.canvas.width=this.canvas.height=16}}request(e){this.
waiting.add(e),this.scheduled||=requestAnimationFrame(t=>this.run(t))}run(e){this.scheduled=0;let t=performance.now()+oo;
for(let r of[...this.waiting])if(this.waiting.delete(r),r.frame(e,t),performance.now()>t)break;this.waiting.size&&(this.
scheduled||=requestAnimationFrame(r=>this.run(r)))}counted(e){if(e===null)throw new Error("the graphics card has no memo\
ry left, or the context is lost");return this.objects+=1,e}free(e,t){if(t===null||this.isLost||!this.gl)return;this.objects-=
1,this.gl[`delete${e}`](t)}hold(e){if(!e.digest)return e;let t=this.stock.get(e.digest)??{part:e,users:0};return this.stock.
set(e.digest,{...t,users:t.users+1}),t.part}release(e){let t=e&&this.stock.get(e.digest);!e||!t||(t.users-=1,t.users||this.
stock.delete(e.digest))}target(e,t,r,n){let s=this.context,o=this.counted(s.createFramebuffer());s.bindFramebuffer(s.FRAMEBUFFER,
o);let c=[[e,s.COLOR_ATTACHMENT0],[s.DEPTH_COMPONENT24,s.DEPTH_ATTACHMENT]].map(([l,h])=>{let u=this.counted(s.createRenderbuffer());
return s.bindRenderbuffer(s.RENDERBUFFER,u),s.renderbufferStorageMultisample(s.RENDERBUFFER,n,l,t,r),s.framebufferRenderbuffer(
s.FRAMEBUFFER,h,s.RENDERBUFFER,u),u});return{frame:o,buffers:c}}freeTarget(e){this.free("Framebuffer",e.frame);for(let t of e.
buffers)this.free("Renderbuffer",t)}bindSmooth(e,t){let r=this.context,n=this.smooth;if(!n||n.width<e||n.height<t){let[s,
o]=[Math.max(e,n?.width??0),Math.max(t,n?.height??0)];n&&this.freeTarget(n);let i=this.target(r.RGBA8,s,o,ao);this.smooth=
{...i,width:s,height:o}}r.bindFramebuffer(r.FRAMEBUFFER,this.smooth?.frame??null)}copySmooth(e,t){let r=this.context;r.bindFramebuffer(
r.READ_FRAMEBUFFER,this.smooth?.frame??null),r.bindFramebuffer(r.DRAW_FRAMEBUFFER,null),r.disable(r.SCISSOR_TEST),r.blitFramebuffer(
0,0,e,t,0,0,e,t,r.COLOR_BUFFER_BIT,r.NEAREST),r.bindFramebuffer(r.FRAMEBUFFER,null)}numbers(e,t=1,r=1){let n=this.context;
this.picker??=this.target(n.RGBA32UI,...io,0),n.bindFramebuffer(n.FRAMEBUFFER,this.picker.frame),n.viewport(0,0,t,r),n.disable(
n.SCISSOR_TEST),n.enable(n.DEPTH_TEST),n.clearBufferuiv(n.COLOR,0,[0,0,0,0]),n.clear(n.DEPTH_BUFFER_BIT),e();let s=new Uint32Array(
4*t*r);return n.readPixels(0,0,t,r,n.RGBA_INTEGER,n.UNSIGNED_INT,s),n.bindFramebuffer(n.FRAMEBUFFER,null),s}};function On(){
let a=globalThis;return a[co]??=new gr}var st=class{size;poles;rays;nodes;isAlongJ;cells;lines;constructor(e,t,r){let[n,s]=t;this.poles=e,this.nodes=t,this.rays=
r,this.isAlongJ=e[0]?.component!==0,[this.lines,this.cells]=this.isAlongJ?[n,s-1]:[s,n-1];let o=e.reduce((i,c)=>i+this.depth(
c)+1,0);this.size={width:s+(this.isAlongJ?0:o),height:n+(this.isAlongJ?o:0)}}laidOut(e){if(!this.poles.length)return e;let[
t,r]=this.nodes,{width:n,height:s}=this.size,o=new Float32Array(4*n*s);for(let i=0;i<t;i+=1)o.set(e.subarray(4*r*i,4*r*(i+
1)),4*n*i);return this.poles.forEach((i,c)=>this.fill(o,i,c)),o}fastest(e){let t=0;for(let r=0;r<(this.isAlongJ?this.size.
height:this.size.width);r+=1){let n=s=>(r-s.line)*s.inward<s.near;if(!(r<this.lines&&this.poles.some(n)))for(let s=0;s<=
this.cells;s+=1){let o=this.at(r,s);t=Math.max(t,Math.abs(e[o]),Math.abs(e[o+1]))}}return t}at(e,t){return 4*(this.isAlongJ?
e*this.size.width+t:t*this.size.width+e)}depth({near:e}){return Math.min(e+3,this.lines-1)}shift(e){let t=this.poles.slice(
0,e).reduce((s,o)=>s+this.depth(o)+1,0),{inward:r,line:n}=this.poles[e];return this.lines+t-(r>0?n:n-this.depth(this.poles[e]))}ray(e,t){
let r=2*(e*(this.cells+1)+t);return[this.rays[r],this.rays[r+1]]}fill(e,t,r){let{cells:n}=this,{line:s,inward:o,component:i}=t,
[c,l]=[this.shift(r),this.still(e,t,r)];for(let h=0;h<=this.depth(t);h+=1)for(let u=0;u<=n;u+=1){let m=this.at(s+o*h,u),
p=this.at(s+o*h+c,u),[f,d]=[e[m+1-i],e[m+i]],[g,b,y]=[u,(u+1)%n,(u+n-1)%n].map(x=>this.ray(r,x));for(let x of[0,1]){let v=(b[x]-
y[x])/2;e[p+x]=h?o*d*g[x]+f*h*v:l[x]}e.copyWithin(p+2,m+2,m+4)}}still(e,{line:t,inward:r,component:n},s){let[o,i,c,l,h]=[
0,0,0,0,0];for(let m=0;m<this.cells;m+=1){let[p,f]=this.ray(s,m),d=p*p+f*f,g=e[this.at(t,m)+n]*r;[l,h]=[l+g*p,h+g*f],[o,
i,c]=[o+p*p/d,i+p*f/d,c+f*f/d]}let u=o*c-i*i;return[(c*l-i*h)/u,(o*h-i*l)/u]}get raysSize(){return[this.cells+1,Math.max(
this.poles.length,1)]}get angles(){let{cells:e}=this,[t,r]=this.raysSize,n=new Float32Array(4*t*r);return this.poles.forEach(
(s,o)=>{let i=[];for(let c=0;c<=e;c+=1){let[l,h]=this.ray(o,c),u=Math.atan2(h,l);for(;u<i[c-1];)u+=2*Math.PI;i.push(u)}i.
forEach((c,l)=>{let h=i[0]+2*Math.PI*l/e+1e-6,u=i.findLastIndex(m=>m<=h);n.set([c,Math.hypot(...this.ray(o,l)),u],4*(o*t+
l))})}),n}get uniforms(){let e=this.poles.flatMap(({line:r,inward:n,near:s},o)=>[r,n,s,this.shift(o)]),t=this.poles.flatMap(
({plane:r})=>r);for(;e.length<8;)e.push(0);for(;t.length<12;)t.push(0);return{u_poles:e,u_planes:t,u_polar:Number(this.isAlongJ)}}};var Fn=32767,[lo,ho,uo,mo]=[0,1,2,3],po=2,fo=8,go=4,bo=4,yo=64,xo=64,vo=2e4,wo=1e30,Nn=1e-5;function In(a,e,t){let[r,n]=t,
s=a.shape[1],[o,i]=e.drawn,c=new Float64Array(r*n*3);for(let l=0,h=0;l<r;l+=1){let u=3*((l+o+1)*s+i+1);for(let m=0;m<3*n;m+=
1)c[h++]=a.data[u+m]+e.middle[m%3]}return{data:c,shape:[r,n,3]}}function Cn(a,e,t){let[r,n]=t,s=3*a.shape[1],[o,i]=e.drawn,
c=new Int16Array(r*n*3);for(let l=0,h=0;l<r;l+=1)for(let u=0;u<n;u+=1,h+=3){let m=s*(l+o+1)+3*(u+i+1),p=g=>[0,1,2].map(b=>a.
data[m+g+b]-a.data[m-g+b]),f=N(p(3),p(s)),d=F(f)||1;for(let g=0;g<3;g+=1)c[h+g]=Math.round(f[g]/d*Fn)}for(let{component:l,
line:h,inward:u}of e.poles??[]){let[m,p]=l?[h-o,n]:[h-i,r];if(m<0||m>=(l?r:n))continue;let f=(y,x)=>3*(l?y*n+x:x*n+y),d=[
0,0,0];for(let y=0;y<p;y+=1)for(let x=0;x<3;x+=1)d[x]+=c[f(m+u,y)+x];let g=F(d)||1,b=d.map(y=>Math.round(y/g*Fn));for(let y=0;y<
p;y+=1)c.set(b,f(m,y))}return{data:c,shape:[r,n,3]}}function ie({slices:a},e){let{trace:t,times:r,lags:n}=a;if(!t?.pathlines||
!t.timed)return[e];let s=n[n.length-1]*t.timed.unit,o=r.map(c=>Math.abs(c-r[e])<s),i=c=>o[c]||o[c-1]||o[c+1];return[...r.
keys()].filter(i)}function Mo({slices:a},e,t,r,n){let{trace:s,times:o}=a;if(!s?.pathlines||!s.timed)return[{from:r,to:n,
steps:[e,e],between:[0,1]}];let i=[],{unit:c}=s.timed,l=h=>t*(o[h]-o[e])/c;for(let h=e;r<n;h+=t){let u=!(h+t in o),m=u?n:
l(h+t);if(m<=r+Nn*n)continue;let p=u?[0,1]:[l(h),m],f=m>=n-Nn*n;i.push({from:r,to:f?n:m,steps:[h,u?h:h+t],between:p}),r=
f?n:m}return i}function at({programs:a},e,t){let{fullVertex:r,trace:n="",layers:s=""}=e.shaders,o=(c,...l)=>{let h=l.filter(
m=>typeof m=="string"),u=a.get(r,c,...h);if(u.error)throw new Error(`the tracer cannot be built: ${u.error}`);return u},
i=t.poles!==void 0&&"FLOWTEX_POLES";return{follow:o(n,i,t.pathlines&&"FLOWTEX_PATHLINES"),compose:t.pathlines?null:o(n,i,
"FLOWTEX_COMPOSED"),slopes:o(s,"FLOWTEX_SLOPES"),tangents:o(s,i)}}var ot=class{graphics;header;trace;find;textures=new Set;frames=[];result=null;passes;flows=new Map;fastest=1;poles;constructor(e,t,r,n,s){
this.graphics=e,this.header=t,this.trace=r,this.find=n,this.poles=new st(r.poles??[],r.nodes,n("rays")?.data??[]),this.passes=
this.slices(s)}advance(e){if(!Object.values(at(this.graphics,this.header,this.trace)).every(r=>r?.ready??!0))return null;
let t=this.graphics.context;try{do{let{done:r,value:n}=this.passes.next();if(t.isContextLost())return null;if(r)return this.
result=null,n}while(performance.now()<e);return null}finally{this.unbind()}}dispose(){for(let e of this.textures)this.graphics.
free("Texture",e);for(let e of this.frames)this.graphics.free("Framebuffer",e);this.result&&!this.graphics.context.isContextLost()&&
this.graphics.context.deleteTexture(this.result),this.result=null,this.textures.clear(),this.frames.length=0}data(e){let t=this.
find(e);if(!t)throw new Error(`the part "${e}" of the scene is missing`);return t.data}numbers(e){let t=this.data(e);return t instanceof
Float32Array?t:new Float32Array(t).map(r=>Le[r])}texture(e,t,r,n){let s=this.graphics.context,o=this.graphics.counted(s.
createTexture());return this.textures.add(o),s.activeTexture(s.TEXTURE0),s.bindTexture(s.TEXTURE_2D,o),s.texStorage2D(s.
TEXTURE_2D,1,r,e,t),s.texParameteri(s.TEXTURE_2D,s.TEXTURE_MIN_FILTER,s.NEAREST),s.texParameteri(s.TEXTURE_2D,s.TEXTURE_MAG_FILTER,
s.NEAREST),n&&s.texSubImage2D(s.TEXTURE_2D,0,0,0,e,t,s.RGBA,s.FLOAT,n),o}frame(){let e=this.graphics.context,t=this.graphics.
counted(e.createFramebuffer());return this.frames.push(t),e.bindFramebuffer(e.FRAMEBUFFER,t),t}target(e,t){let r=this.graphics.
context,n=this.texture(e,t,r.RGBA32UI,null),s=this.frame();return r.framebufferTexture2D(r.FRAMEBUFFER,r.COLOR_ATTACHMENT0,
r.TEXTURE_2D,n,0),[n,s]}unbind(){let e=this.graphics.context;for(let t=0;t<fo;t+=1)e.activeTexture(e.TEXTURE0+t),e.bindTexture(
e.TEXTURE_2D,null),e.bindTexture(e.TEXTURE_2D_ARRAY,null);e.bindFramebuffer(e.FRAMEBUFFER,null)}flow(e){let{trace:t}=this,
r=this.numbers(`flow/${e}`),n=this.data("unit"),s=r.length/n.length,o=new Float32Array(4*n.length);for(let c=0,l=0;c<n.length;c+=
1,l+=s){let h=r[l+2],u=Le[n[c]]*t.unit;o[4*c]=r[l]*h/u,o[4*c+1]=r[l+1]*h/u,o[4*c+2]=h,o[4*c+3]=t.timed?t.timed.unit:u}let i=this.
poles.laidOut(o);return t.timed&&(this.fastest=Math.max(this.fastest,this.poles.fastest(i)*t.timed.speed*t.timed.unit)),
i}wholeSpeed(e){let t=this.numbers(`flow/${e}`),r=this.data("unit").length,n=t.length/r,s=Number(this.trace.uncertain??!1),
o=new Float32Array(4*r);for(let i=0;i<r;i+=1)o[4*i]=t[(i+1)*n-1-s],o[4*i+1]=s*t[(i+1)*n-1];return o}cells(){let[e,t]=this.
trace.nodes,[r,n]=["open","nearest"].map(o=>this.find(o)?.data),s=new Float32Array(4*e*t);for(let o=0;o<e*t;o+=1){s[4*o]=
r?r[o]:1;for(let i of[0,1])s[4*o+1+i]=n?n[2*o+i]:0}return s}padded(){let e=this.data("padded"),t=new Float32Array(e.length/
3*4);for(let r=0;r<e.length/3;r+=1)for(let n=0;n<3;n+=1)t[4*r+n]=e[3*r+n];return t}flowTexture(e){let{width:t,height:r}=this.
poles.size,n=this.graphics.context,o=this.flows.get(e)??this.texture(t,r,n.RGBA32F,this.flow(e));this.flows.delete(e),this.
flows.set(e,o);for(let[i,c]of this.flows){if(this.flows.size<=bo)break;this.flows.delete(i),this.textures.delete(c),this.
graphics.free("Texture",c)}return o}partsOf({from:e,to:t}){let r=T(Math.ceil((t-e)*this.fastest/yo),1,xo),n=s=>s===r?t:e+
(t-e)*s/r;return Array.from({length:r},(s,o)=>[n(o),n(o+1)])}*slices(e){let{graphics:t,trace:r,header:n}=this,s=t.context,
{geometry:o,slices:i}=n,[c,l]=r.nodes,[h,u]=[o.rows.size,o.columns.size],m={width:u,height:h,layers:i.count,channels:4,levels:o.
levels},p=s.createTexture();this.result=p,s.activeTexture(s.TEXTURE0),et(s,p,m);let{poles:f}=this,d=this.texture(f.size.
width,f.size.height,s.RGBA32F,this.flow(e)),g=this.texture(...f.raysSize,s.RGBA32F,f.angles),b=[this.texture(l,c,s.RGBA32F,
this.cells()),this.texture(l+2,c+2,s.RGBA32F,this.padded()),this.texture(l,c,s.RGBA32F,this.wholeSpeed(e))],y=[0,1,2,3,4].
map(()=>this.target(l,c)),{lags:x,sides:v,count:w}=i,M={u_flow:0,u_cells:1,u_padded:2,u_speed:3,u_before:4,u_last:5,u_earlier:5,
u_flowNext:6,u_rays:7,...f.uniforms,u_longest:r.longest??wo,u_nodes:[l,c],u_closed:[Number(r.closed[1]),Number(r.closed[0])],
u_first:[r.first[1],r.first[0]],u_texels:[u,h],u_offsetJ:r.offset.slice(0,3),u_offsetI:r.offset.slice(3,6),u_timed:r.timed?.
speed??0,u_rest:r.rest,u_pace:r.pace,u_unit:i.unit,u_cell:i.cell/i.unit,u_planar:Number(o.planar),u_mostReach:2*x[x.length-
1]},A=([U,Z],we,ue,Re)=>{s.viewport(0,0,U,Z);for(let X of[s.SCISSOR_TEST,s.DEPTH_TEST,s.BLEND,s.CULL_FACE])s.disable(X);
we.forEach((X,te)=>{s.activeTexture(s.TEXTURE0+te),s.bindTexture(s.TEXTURE_2D,X)}),s.bindVertexArray(null),t.programs.use(
ue,{...M,...Re}),s.drawArrays(s.TRIANGLES,0,3)},S=this.frame(),_=(U,Z,we,ue)=>{s.bindFramebuffer(s.FRAMEBUFFER,S),s.framebufferTextureLayer(
s.FRAMEBUFFER,s.COLOR_ATTACHMENT0,p,0,U),A([u,h],[d,...b,...we],Z,ue)},{follow:L,compose:C,slopes:I,tangents:J}=at(t,n,r);
_(0,J,[],{u_inCells:0}),w>1+v*x.length&&_(w-1,J,[],{u_inCells:1});let ae=0;for(let U=0;U<v;U+=1){let Z=U?1:-1,we=1+U*x.length,
[ue,Re,X]=[y[0],y[0],y[0]];for(let[te,Ze]of x.entries()){let[Gr,Wr]=[x[te-1]??0,x[te-2]??0],$r=Ze>go&&Wr>0?C:null,Qe=X;for(let ir of Mo(
n,e,Z,Gr,Ze)){let[Ua,Va]=ir.steps.map(cr=>this.flowTexture(cr)),Da=$r?[[Gr,Ze]]:this.partsOf(ir);for(let[cr,Ba]of Da){let jr=y.
find(Ha=>![ue,Re,X,Qe].includes(Ha))??y[0];s.bindFramebuffer(s.FRAMEBUFFER,jr[1]),A([l,c],[Ua,...b,Qe[0],Re[0],Va,g],$r??
L,{u_lagEarlier:Wr,u_from:cr,u_to:Ba,u_side:Z,u_between:ir.between}),Qe=jr,!((ae+=c*l)<vo)&&(s.readPixels(0,0,1,1,s.RGBA_INTEGER,
s.UNSIGNED_INT,new Uint32Array(4)),ae=0,yield)}}[Re,X]=[X,Qe],te||(ue=X);let Ia=r.uncertain&&te===po,Ca=te===1&&!U?ho:Ia?
mo:lo;te&&_(we+te,I,[X[0],X[0]],{u_fourth:Ca,u_lag:Z*Ze})}_(we,I,[ue[0],X[0]],{u_fourth:uo,u_lag:Z*x[0]})}return s.activeTexture(
s.TEXTURE0),s.bindTexture(s.TEXTURE_2D_ARRAY,p),m.levels&&s.generateMipmap(s.TEXTURE_2D_ARRAY),p}};var Eo={slices:[12,4],flow:[100,24]},So=24,it=class{all=new Map;graphics;constructor(e){this.graphics=e}set(e){let{name:t,
digest:r}=e;if(r&&this.all.get(t)?.digest===r)return!1;let n=this.graphics.hold(e);return this.remove(t),this.all.set(t,
n),!0}remove(e){this.graphics.release(this.all.get(e)),this.all.delete(e)}clear(e=()=>!0){for(let t of[...this.all.keys()])
e(t)&&this.remove(t)}trim(e,t,r){let{hasSteps:n=!1,hasMarks:s=!1,memory:o=0}=t??{};if(!e||!n)return;for(let h of s?Object.
keys(Me):[]){let u=[...this.all.keys()].filter(m=>m.startsWith(`${h}/`));for(let m of u.slice(0,-So))r.includes(Y(m))||this.
remove(m)}let i=e.slices.trace?"flow":"slices",c=h=>[...this.all.keys()].filter(u=>u.startsWith(h)),l=r.flatMap(h=>ie(e,
h));for(let h of c(`${i}/`).slice(0,-Eo[i][+(o>0)])){let u=Y(h);if(l.includes(u))continue;for(let p of[i,"extra"])this.remove(
`${p}/${u}`);let m=o?c("scalars/"):[];for(let p of m)Ee(p,u,e)&&this.remove(p)}}};var ct=class{controller=new AbortController;observers=new Set;timers=new Set;globalListeners=0;get isOver(){return this.
controller.signal.aborted}listen(e,t,r,n={}){(e===document||e===window)&&(this.globalListeners+=1);let{signal:s}=this.controller;
e.addEventListener(t,r,{...n,signal:s})}later(e,t){let r=setTimeout(()=>{this.timers.delete(r),e()},t);return this.timers.
add(r),r}cancel(e){e!==null&&(clearTimeout(e),this.timers.delete(e))}observe(e,t){e.observe(t),this.observers.add(e)}watch(e,t,r){
e.observe(t,r),this.observers.add(e)}stats(){let{globalListeners:e,observers:t,timers:r}=this;return{listeners:e,observers:t.
size,timers:r.size}}end(){this.controller.abort(),this.globalListeners=0;for(let e of this.observers)e.disconnect();this.
observers.clear();for(let e of this.timers)clearTimeout(e);this.timers.clear()}};function Un(a,e,t){let{geometry:r,slices:n,constants:s}=a,o=e,i=me(a),c=2**(Math.floor(Math.log2(r.extent))-s.noiseDoublings),
l=t.eye[3],h=O(r.frame,E(t.eye,k(r.center,l))),u=br(a,e),m=u?"ramp":o.kernel,p=i&&m==="ramp"?"hann":m;return{u_eye:[...E(
h,k(t.anchor,l)),l],u_between:t.between,u_slicesSize:[r.columns.size,r.rows.size],u_deepest:r.levels,u_lags:n.lags,u_lagCount:n.
lags.length,u_sides:o.two_sided||i||u?n.sides:1,u_unit:n.unit,u_rateLayer:n.count-1,u_cell:n.cell,u_samples:lt(a,e,t.still)?
2*o.samples-1:o.samples,u_spacing:o.spacing,u_grain:o.grain*t.density,u_kernel:s.kernels.indexOf(p),u_lod:o.lod,u_contrast:o.
contrast,u_strength:o.strength,u_even:yr(a,e),u_fade:i?0:o.fade,u_seed:o.seed,u_showLevel:o.show_level,u_fixed:o.fixed_grain,
...To(a,o,t),...Ao(a,t,c),..._o(a,t,c),u_noiseFinest:c,u_texel:r.extent/o.resolution,u_apart:xr(a,e)*t.density,u_bySpeed:e.
arrow_length==="speed",u_arrowSides:n.sides,u_pieces:s.arrows.pieces,...a.image?Po(a.image,o.tiles,t.density):{}}}function lt(a,e,t=!1){
let r=e.motion!=="off"&&!me(a);return!a.image&&(r||a.slices.steps>1&&!t)}function br(a,e){return!a.image&&e.texture==="s\
treaklets"}function yr(a,e){return!!(e.lod&&!e.fixed_grain)&&!a.image&&!br(a,e)}function ke(a,e){return Number(e.arrows)>
0&&!me(a)&&!a.image}function xr({constants:a},{arrows:e}){return a.arrows.least*Math.max(Number(e),a.arrows.mostDense)}function ht(a,e,t){
let{geometry:r,slices:n,constants:s}=a,o=e,i=Math.hypot(...E(t.eye,r.center))-.5*r.extent,c=t.eye[3]?Math.max(i,0)/Math.
hypot(...E(t.eye,t.focus)):1,l=o.lod?t.pixel*c*o.grain*t.density:r.extent/o.resolution;return Math.floor(o.samples/2)*o.
spacing*l<s.farCells*n.critical}function Vn(a,e,t,r){let n={FLOWTEX_CELLS:t,FLOWTEX_MOVING:lt(a,e,r),FLOWTEX_SPARSE:br(a,
e),FLOWTEX_REPEATED:!!a.ends};return Object.entries(n).flatMap(([s,o])=>o?[s]:[])}function To(a,e,t){let{geometry:r,constants:n}=a,
{times:s,pace:o}=a.slices,i=s.length>1,c=!i&&e.speed_in==="pixels",l=s[s.length-1]-s[0],h=l*o/r.extent,u=i?l/(Math.round(
h)||h):e.period,m=(i?t.time-s[0]:t.clock)/u%n.mostTurns,p=u*(i?o:e.speed),f=m%n.clockStep;return{u_clock:[m-f,f],u_travel:p*
(c?t.density:1),u_travelInPixels:c,u_travelBySpeed:i||e.motion==="speed",u_wave:n.wavePixels*t.density}}function Ao(a,e,t){
let{noiseDoublings:r,clearDoublings:n}=a.constants,{frame:s,center:o}=a.geometry,i=O(s,E(e.focus,o)),c=2**(r-n)-1,l=2**n,
h=i.map(p=>T(Math.round(p/t/l),-c,c)*l),u=h.map(p=>p/Math.SQRT2),m=u.map(p=>Math.floor(p/l)*l);return{u_noiseOrigin:h.map(
(p,f)=>p*t-e.anchor[f]),u_noiseOriginEven:h,u_noiseOriginOdd:m,u_noiseRestOdd:u.map((p,f)=>p-m[f])}}function _o(a,e,t){let{
ends:r,geometry:n,constants:s}=a;if(!r)return{};let{frame:o,center:i}=n,c=O(o,[1,0,0]),[l,h]=r.map(g=>g-i[0]-P(c,e.anchor)),
u=2**s.clearDoublings,m=k(c,(r[1]-r[0])/t),p=k(m,Math.SQRT1_2),f=g=>g.map(b=>Math.floor(b/u)*u),d=g=>g.map(b=>b-Math.floor(
b/u)*u);return{u_ends:[c[0],c[1],l,h],u_turnEven:f(m),u_turnRestEven:d(m),u_turnOdd:f(p),u_turnRestOdd:d(p)}}function Po({
size:a,stepSize:e,repeat:t},r,n){return{u_stepSize:e.map(s=>s*n),u_imageSize:a.map(s=>s*n*r),u_imageRound:[Number(t[1]),
Number(t[0])],u_tiles:r}}function vr(a,e){if(a.length<2)return[0,0,0];let t=0;for(;t<a.length-2&&a[t+1]<=e;)t+=1;let r=(e-
a[t])/(a[t+1]-a[t]);return[t,t+1,T(r,0,1)]}var Ro=.5,Lo=6,ko=60,Oo=.5,ut=class{time=0;clock=0;playing=!1;pace=1;times=[0];lastFrame=0;hasHeader=!1;setHeader(e){let{
times:t}=e.slices;(!(t.length===this.times.length&&t.every((n,s)=>n===this.times[s]))||!this.hasHeader)&&(this.time=e.time,
this.clock=e.clock),this.hasHeader=!0,this.times=t}get varies(){return this.times.length>1}get span(){return[this.times[0],
this.times[this.times.length-1]]}get moment(){return vr(this.times,this.time)}timeOf([e,t,r]){return this.times[e]+r*(this.
times[t]-this.times[e])}seek(e){this.time=T(e,...this.span)}stepFrom(e){let{times:t,time:r}=this,n=t.findIndex(i=>e>0?i>
r:i>=r),s=t.length,o=n<0?s:n;return t[(e>0?o:o-1+s)%s]}start(){this.playing=!0,this.lastFrame=0}range(e){if(this.varies)
return{first:this.span[0],last:this.span[1],now:this.time};let t=Number(e.period);return{first:0,last:t,now:this.clock%t}}advance(e,t){
let r=this.lastFrame?Math.min((e-this.lastFrame)/1e3,Oo)*this.pace:0;if(this.lastFrame=e,!this.varies)return this.clock+=
r,!0;let[n,s]=this.span,o=T(Ro*(this.times.length-1),Lo,ko),i=this.time+r*(s-n)/o,[c,l]=vr(this.times,Math.min(i,s));return t(
[c,l])?(this.time=i>s?n:i,!0):!1}};var Dn=()=>null,mt=class{};var D="",Bn=5,G=a=>a.join("/"),ce=a=>a.split("/").map(Number);function Hn(a,e){let[t,r,n]=["samples","spacing","grain"].
map(o=>Number(e[o])),s=.5*t*r*n;return a.cellPixels*Math.max(1,2*s/(a.cellPixels*a.pathCells))}var pt=class{header;place;constructor(e,t){
this.header=e;let r=0,n=e.blocks.map(([s,o])=>(r+=s*o)-s*o);this.place=typeof t=="function"?t:(s,o,i)=>{let c=Bn*(n[s]+o*
e.blocks[s][1]+i);return t.subarray(c,c+Bn)}}blocksOf(e,[t,r,n]){let[s,o]=this.header.blocks[t];if(e===D)return[0,0,s,o];
let{tileBlocks:i}=this.header,c=[Math.min(i*(r+1),s),Math.min(i*(n+1),o)];return[i*r,i*n,...c]}children(e,[t,r,n]){let{blocks:s,
tileBlocks:o}=this.header,i=s[t-1].map(u=>Math.ceil(u/o)),[c,l]=e===D?[[0,0],i]:[[2*r,2*n],[r,n].map((u,m)=>Math.min(2*u+
2,i[m]))],h=[];for(let u=c[0];u<l[0];u+=1)for(let m=c[1];m<l[1];m+=1)h.push([t-1,u,m]);return h}finerPart([,e,t],r){let{
tileBlocks:n}=this.header,s=n/2,[,o,i]=r===D?[0,0,0]:ce(r);return[s*e-n*o,s*t-n*i,s]}choose(e){let t=new Map,{depth:r,finest:n}=this.
header,s=[D];for(let o of s){let i=o===D?[r,0,0]:ce(o),c={key:i,needed:!1,pixels:0,finer:[]},[l,h,u,m]=this.blocksOf(o,i),
p=this.header.blocks[i[0]][1],f=new Set;for(let d=l;d<u;d+=1)for(let g=h;g<m;g+=1){let b=this.place(i[0],d,g);if(!wr(e,b)||
e.shownOn?.sees(b)===!1)continue;let y=Mr(e,b)*(e.shownOn?.scale(b)??1);i[0]>n&&y>e.cellPixels?f.add(d*p+g):c.needed=!0,
f.has(d*p+g)||(c.pixels=Math.max(c.pixels,y))}f.size&&(c.finer=this.children(o,i).filter(d=>{let[g,b,y]=this.finerPart(d,
D);return[...f].some(x=>{let[v,w]=[Math.floor(x/p)-g,x%p-b];return v>=0&&v<y&&w>=0&&w<y})}).map(G)),t.set(o,c),s.push(...c.
finer)}return t}};function wr({planes:a},[e,t,r,n]){return a.every(s=>P(s,[e,t,r])+s[3]>=-n*F(s.slice(0,3)))}function Mr({
eye:a,halfHeight:e,pixels:t},[r,n,s,o,i]){let c=a?Math.max(F(E([r,n,s],a))-o,i):1;return i*.5*t/(e*c)}function zn(a){return[
...a].filter(([t,{needed:r}])=>t!==D&&r).sort(([,t],[,r])=>r.pixels-t.pixels).map(([t])=>t)}function Er(a,e){let t=new Map,
r=s=>{t.delete(s),a.get(s)?.finer.forEach(r)},n=s=>{let{needed:o=!1,finer:i=[]}=a.get(s)??{},c=i.filter(n);return s!==D&&
!o&&c.length===i.length?!0:s!==D&&!e(s)?(c.forEach(r),!1):(t.set(s,c),!0)};return n(D),t}function ft(a,e,t){let r=s=>Math.
min(s*2**e,t-1),n=Math.floor(a);return r(n)+(a-n)*(r(n+1)-r(n))}function Gn(a,e,t){let r=2**e,n=Math.max(Math.min(Math.floor(
a/r),Math.ceil((t-1)/r)-1),0);return n+(a-n*r)/(Math.min((n+1)*r,t-1)-n*r)}var Wn=1e4,Fo=20,No=4,Io=4,Co="The surface is shown coarse",Uo="A part of the surface is shown coarse",Vo="A time step c\
annot be shown",Te=class{times=new Map;now;constructor(e=()=>performance.now()){this.now=e}add(e){this.times.set(e,this.
now())}has(e){return this.now()-(this.times.get(e)??-1/0)<Wn}},Oe=class{source;taker;running=new Map;jobs=[];failed=new Te;constructor(e,t){
this.source=e,this.taker=t}want(e){this.jobs=e;let t=new Set(e.map(String));for(let[r,n]of this.running)t.has(r)||(this.
running.delete(r),n.abort());this.next()}stop(){this.want([]),this.failed=new Te}next(){for(let e of this.jobs){if(this.
running.size>=(this.source()?.atOnce??No))return;!this.running.has(String(e))&&!this.failed.has(String(e))&&this.run(e)}}async run(e){
let{taker:t}=this,r=this.source();if(!r)return;let[n,s,o]=e,i=new AbortController,{signal:c}=i,l=h=>n?t.tiles?.has(G(n),
h)??!1:t.parts.has(h);this.running.set(String(e),i);try{let h=await r.load(n,s,c,l,o);if(!c.aborted)for(let u of h)t.setPart(
u)}catch(h){c.aborted||this.fail(e,h)}c.aborted||(this.running.delete(String(e)),this.failed.has(String(e))||(this.jobs=
this.jobs.filter(h=>String(h)!==String(e))),this.next())}fail(e,t){let[r,n]=e;this.failed.add(String(e)),setTimeout(()=>this.
next(),Wn+Fo);let s=t.fault==="unreachable",o=r&&!s?G(r):void 0;this.taker.lack($n(r?Uo:Vo,t),o,n)}};function $n(a,e){let{
fault:t,message:r=String(e),detail:n=""}=e;return console.warn(r,n),t==="other"?r:`${a}: ${r}`}var dt=class{tiles;wholes;marks;given;formula=null;constructor(e,t){
this.given=e,this.tiles=new Oe(()=>this.source,t),this.wholes=new Oe(()=>this.source,t),this.marks=new Oe(()=>this.source,
t)}get source(){return this.formula??this.given}get hasSteps(){return this.source?.hasSteps??!1}get hasMarks(){return this.
source?.hasMarks??!1}setHeader(e){this.stop(),this.formula=e.formula?new mt(e,e.formula):null}follow(e){return this.formula?.
follow(e)??!1}fit(){return this.formula?.fit()??!1}trajectory(e){return this.formula?.trajectory(e)??null}open(){let{taker:e}=this.
tiles;this.source?.open?.().catch(t=>e.lack($n(Co,t)))}wantTiles(e,t){this.tiles.want(e.map(r=>[r,t]))}wantSteps(e){let t=this.
wholes.jobs.flatMap(([,n])=>n);if(e.every(n=>t.includes(n)))return;let r=[...new Set([...e,...t])].slice(0,e.length+Io);
this.wholes.want(r.map(n=>[null,[n]]))}wantMarks(e){let t=e.map(([r,n])=>[null,[n],r]);String(t)!==String(this.marks.jobs)&&
this.marks.want(t)}stop(){this.tiles.stop(),this.wholes.stop(),this.marks.stop()}};function jn({header:a,camera:e,anchor:t,player:r,rows:n},s,o){let{geometry:i,constants:c}=a,l=e.state.focal_point,h=O(i.
frame,E(l,i.center)),u=c.anchorRange*2*e.height,m=p=>p.some(f=>Math.abs(f)>u);return{focus:l,anchor:m(E(h,t))?m(h)?h:[0,
0,0]:t,eye:e.eye,between:s[2],time:r.timeOf(s),clock:r.clock,still:!r.playing,density:o,pixel:2*e.height/Math.max(n*o,1)}}var Do=-1e9,Xn=500;function gt(a,e){if(a instanceof Float32Array&&!e.some(Boolean))return a;let t=new Float32Array(a.length);
for(let r=0;r<a.length;r+=1)t[r]=a[r]-e[r%3];return t}function Yn({shape:a,rows:e,columns:t}){return Float32Array.from({
length:2*a[0]*a[1]},(r,n)=>{let[s,{before:o,size:i}]=n%2?[Math.floor((n>>1)/a[1]),e]:[(n>>1)%a[1],t];return(s+o+.5)/i})}
function qn(a,e){let t=Math.max(a.length,e.length);return Float32Array.from({length:2*t},(r,n)=>(n%2?e:a)[n>>1]??0)}function Kn(a){
let e=Float32Array.from(a);for(let t=0;t<a.length;t+=3){let r=Math.hypot(a[t],a[t+1],a[t+2])||1;for(let n=t;n<t+3;n+=1)e[n]/=
r}return e}function bt(a,e){let t=a[0]?.length??0,r=new Float32Array(2*t),n=hr(e);return a.forEach((s,o)=>{for(let i=0;i<
t;i+=1){let c=n(s[i]);r[2*i+o]=Number.isFinite(c)?T(c,-Xn,Xn):Do}}),r}function Jn([a,e],[t,r]){let[n,s]=[Math.min(Math.floor(
t),e-2),Math.min(Math.floor(r),a-2)],[o,i]=[t-n,r-s],c=s*e+n,[l,h]=[Math.min(o,i),Math.max(o,i)],u=c+(o>=i?1:e);return[[
c,1-h],[u,h-l],[c+e+1,l]]}function yt(a,e){return a.reduce((t,[r,n])=>t+n*e(r),0)}var Bo=1-1e-7;function Zn(a,e){return Uint32Array.
from({length:4*e.length},(t,r)=>r%4<3?a[3*(r>>2)+r%4]:e[r>>2])}function Fe(a,e,t){return[t,a+Math.min(Math.max(e,0),Bo)]}
function Qn(a,[e,t]){let r=Math.floor(t),[n,s]=[t-r,e];return[1-n-s,n,s].map((o,i)=>[a[3*r+i],o])}var es=180/Math.PI;var Ho=1e-4;function zo(a){let[e,t,r]=[a-1,a-2,a-3];return[-(e*t*r)/6,a*t*r/2,-(a*e*r)/2,a*e*t/6]}function ts(a,e){let t=a*(e-1),r=T(
Math.floor(t)-1,0,e-4);return[r,zo(t-r)]}function Sr([a,e,t,r],{data:n,shape:s},o){let[i,c]=s,[l,h]=ts((o[0]-a)/(t-a),c),
[u,m]=ts((o[1]-e)/(r-e),i),p=[0,0,0];return m.forEach((f,d)=>{h.forEach((g,b)=>{for(let y=0;y<3;y+=1)p[y]+=g*f*n[3*((u+d)*
c+l+b)+y]})}),p}function xt(a,e,t){if(a.map&&!t)return null;let[r,n,s]=a.map&&t?Sr(a.map,t,e):e,o=[Math.atan2(n,r),Math.
atan2(s,Math.hypot(r,n))];return o.every(Number.isFinite)?[o[0]*es,o[1]*es]:null}function rs(a,e,t,r){let[n,s]=[e,t];if(a.
map&&r){let{map:p,radius:f}=a,d=Ho*(p[2]-p[0])/(Math.hypot(...t)||1),[g,b]=[-d,d].map(y=>Sr(p,r,e.map((x,v)=>x+y*t[v])));
n=Sr(p,r,e),s=b.map((y,x)=>f*(y-g[x])/(2*d))}let[o,i,c]=n,[l,h]=[Math.hypot(o,i)||1,Math.hypot(o,i,c)||1],u=(o*s[1]-i*s[0])/
l,m=(o*s[0]+i*s[1])/l;return[u,(l*s[2]-c*m)/h]}var is=2,ns=8,Go=4,Wo=10,cs=.05,ls=.25,ss=4,$o=.01,hs=1e-6,jo=.001;function Xo({scene:a,place:e},[t,r]){let{rows:n,columns:s,
triangles:o}=a.header.geometry;if(o){let p=[-t-r,t,r];return a.cornersAt(e).map(([f,d],g)=>[f,d+p[g]])}let[i,c]=[e[0]+t+
s.before,e[1]+r+n.before],[l,h]=[Math.floor(i),Math.floor(c)],[u,m]=[i-l,c-h];return[(1-u)*(1-m),u*(1-m),(1-u)*m,u*m].map(
(p,f)=>{let d=T(l+(f&1),0,s.size-1);return[T(h+(f>>1),0,n.size-1)*s.size+d,p]})}function Tr(a,e=[0,0]){let{scene:t,moment:r}=a,
{slices:n}=t.header,s=Xo(a,e),[o,i,c]=r,l=s.map(([p])=>p),h=(o===i?[o]:[o,i]).map(p=>t.texels(p,l)),u=o===i?[1]:[1-c,c],
m=me(t.header)?Yo(s.map((p,f)=>h[0](0,f))):s.map(()=>1);return p=>{let f=[0,0,0,0];return s.forEach(([,d],g)=>{let b=p+(p>
n.lags.length?-1:1)*n.lags.length,y=m[g]<0&&p>0?b:p;h.forEach((x,v)=>{u[v]&&x(y,g).forEach((w,M)=>{let A=p===is&&M===3?Math.
max(w,0):w;f[M]+=d*u[v]*A*(M<3?m[g]:1)})})}),f}}function Yo(a){let e=[0,0,0];return a.map(([t,r,n])=>{let s=P(e,[t,r,n])<
0?-1:1;return e=R(e,[t,r,n],s),s})}function qo(a,e,t,r,n){let[s,o]=[a(0).slice(0,3),0],i=a(t+1)[3],c=Math.min(i,e[e.length-
1]),l=[];for(let h=0;h<e.length&&o<c;h+=1){let u=a(t+h+1).slice(0,3);for(let m=1;m<=ns;m+=1){let p=m/ns,f=Math.min(o+p*(e[h]-
o),c),d=(f-o)/(e[h]-o),g=s.map((b,y)=>b+d*(u[y]-b));if(l.push(k(g,r*f*n)),f===c)break}[s,o]=[u,e[h]]}return l}function us({
scene:a,place:e,position:t}){let{image:r,geometry:n}=a.header;if(!r)return l=>R(t,K(n.frame,l));let{alongI:s,alongJ:o}=r,
i=[as(s,e[0]),as(o,e[1])],c=Ne(a,e);return([l,h])=>{let u=[os(s,i[0]+l),os(o,i[1]+h)];return u.some(Number.isNaN)?null:R(
t,E(Ne(a,u),c))}}function Ie(a,e){return R(Ne(a,e),a.header.geometry.center)}function Ne(a,e){let{data:t}=a.part("positi\
on"),r=a.cornersAt(e),n=[0,1,2].map(s=>yt(r,o=>t[3*o+s]));return K(a.header.geometry.frame,n)}function ms(a,e){let{shape:t,
triangles:r}=a.header.geometry;if(r){let i=(c,l)=>Ne(a,Fe(Math.floor(e[1]),c,l));return[E(i(1,0),i(0,0)),E(i(0,1),i(0,0))]}
let[n,s]=e.map((i,c)=>T(i,.5,t[1-c]-1.5)),o=(i,c)=>Ne(a,[n+i,s+c]);return[E(o(.5,0),o(-.5,0)),E(o(0,.5),o(0,-.5))]}function as(a,e){let t=Math.min(Math.floor(e),a.length-2);return a[t]+(e-t)*(a[t+1]-a[t])}function os(a,e){let t=a.findIndex(
r=>r>=e);return t<0||e<a[0]?NaN:t===0?0:t-1+(e-a[t-1])/(a[t]-a[t-1])}function Ko({scene:a,place:e,position:t},r,n,s){let{
geometry:o,image:i}=a.header,c=N(...ms(a,e)),{height:l,ray:h}=n.at(t),u=Math.max(Math.abs(P(V(c),h)),cs),m=2*l/s;if(i){let[
b,y]=[i.alongI,i.alongJ].map((v,w)=>{let M=Math.min(Math.floor(e[w]),v.length-2);return(v[M+1]-v[M])*i.stepSize[w]}),x=Math.
sqrt(F(c)/(b*y));return r.lod?Math.max(m/Math.sqrt(u),x):x}let p=o.extent/Number(r.resolution),f=P(h,n.at(n.state.focal_point).
ray),g=m*Math.sqrt(Math.max(f,ls/u)/u)*Number(r.grain);return r.lod?r.fixed_grain?Math.max(g,p):g:p}function Jo(a,e,t){let{
scene:r,position:n}=a,{geometry:s,image:o}=r.header;if(o||!e.lod||e.fixed_grain)return 1;let i=V(N(...ms(r,a.place))),c=V(
N(i,K(s.frame,Tr(a)(0).slice(0,3))));if(F(c)<.5)return 1;let{ray:l}=t.at(n),h=P(i,l),u=(h<0?-1:1)*Math.max(Math.abs(h),cs),
[m,p]=t.axes.slice(0,2).map(v=>R(v,l,-P(i,v)/u)),f=F(N(m,p)),d=.5*(P(m,m)+P(p,p)),g=Math.sqrt(d+Math.sqrt(Math.max(d**2-
f**2,0))),b=Math.sqrt(g*Math.max(f/g,ls*g)),y=Math.hypot(P(m,c),P(p,c)),x=T(f/(y*b),1/ss,ss);return Math.abs(x-1)<$o?1:x}
function Zo(a,e,t){let r=[],[n,s]=[a,t];for(let o of e){let i=F(E(o,n));if(i>=s){s>0&&r.push(R(n,E(o,n),s/(i||1)));break}
r.push(o),s-=i,n=o}return r}function ps([a,e,t]){return a===e?[[[a,a,0],1]]:[[[a,a,0],1-t],[[e,e,0],t]]}function Ar(a){let e=[
0,0,0];for(let[t,r]of ps(a.moment))r&&(e=R(e,Qo({...a,moment:t}),r));return e}function Qo(a){let{scene:e,position:t}=a,{
slices:r,image:n,speed:s}=e.header,o=Tr(a),[i,c,l]=o(0),h=[i,c,l],u=k(h,jo*(n?1/n.stepSize[0]:r.cell)/(F(h)||1)),m=F(h)>
hs?E(us(a)(u)??t,t):h;return k(V(m),o(is)[3]*s.typical)}function fs(a,e,t,r){let{scene:n,position:s}=a,{slices:o,image:i}=n.
header,c=Tr(a),l=!me(n.header),h=c(0),u=[h[0],h[1],h[2]],m=us(a),p=[],f=e.two_sided||!l?o.sides:1;for(let M=0;M<f&&F(u)>
hs;M+=1){let A=i?1:h[3]*o.unit,_=qo(c,o.lags,M*o.lags.length,M?1:-1,A).map(m),L=_.findIndex(C=>C===null);p.push(_.slice(
0,L<0?void 0:L))}let d=Number(e.samples),g=lt(n.header,e,!0)?2*d-1:d,y=(f===2?Math.floor(g/2):g-1)*Jo(a,e,t),x=Number(e.
spacing)*Ko(a,e,t,r),v=M=>{let[A=[],S=[]]=p.map(_=>Zo(s,_,M));return[...A.reverse(),s,...S]};return{path:v(Go*Math.max(y,
Wo)*x),sampled:v(y*x),directed:l,velocity:Ar(a)}}var ei=8,ti=1e-6,ri=.001,ni=89.99,si=a=>a-360*Math.round(a/360);function _r([a,e]){return[[a,e],[a+1,e],[a,e+1],[a+1,e+1]]}
function vt({header:a},e){return e.map((t,r)=>T(Math.floor(t),0,a.geometry.shape[1-r]-2))}var ds=([a,e])=>[(1-a)*(1-e),a*
(1-e),(1-a)*e,a*e];function gs(a,e,[t,r],n){let{earth:s}=a.header,o=_r(e).map(d=>s&&xt(s,Ie(a,d),n));if(o.some(d=>!d||Math.
abs(d[1])>ni))return null;let[i,c,l,h]=o.map(d=>[si(d[0]-t),d[1]-r]),[u,m]=[c,l].map(d=>[d[0]-i[0],d[1]-i[1]]),p=Math.max(
...[...u,...m].map(Math.abs)),f=u[0]*m[1]-u[1]*m[0];return!f||[0,1].some(d=>Math.abs(i[d]-c[d]-l[d]+h[d])>ri*p)?null:[(i[1]*
m[0]-i[0]*m[1])/f,(i[0]*u[1]-i[1]*u[0])/f]}function bs(a,e,t,r){let{earth:n,geometry:s}=a.header,o=n&&!s.triangles&&xt(n,
t,r);if(!o)return e;let i=vt(a,e);for(let c=0;c<ei;c+=1){let l=gs(a,i,o,r);if(!l)return e;let h=l.map(m=>Math.abs(m-.5)>
.5+ti?m:0),u=vt(a,i.map((m,p)=>m+h[p]));if(String(u)===String(i))return i.map((m,p)=>m+T(l[p],0,1));i=u}return e}function ys(a,e){
let{earth:t,geometry:r}=a.header;if(!t||r.triangles)return a.cornersAt(e);let n=vt(a,e),s=ds(e.map((o,i)=>o-n[i]));return _r(
n).map(([o,i],c)=>[i*r.shape[1]+o,s[c]])}function xs(a,e){let{scene:t,place:r,position:n}=a,{earth:s,geometry:o}=t.header,
i=s&&xt(s,n,e);if(!i)return null;let c=m=>rs(s,m.position,Ar(m),e),l=vt(t,r);if(o.triangles||!gs(t,l,i,e))return c(a);let h=ds(
r.map((m,p)=>m-l[p])),u=_r(l).map(m=>c({...a,place:m,position:Ie(t,m)}));return[0,1].map(m=>u.reduce((p,f,d)=>p+h[d]*f[m],
0))}var ai=16;function ws(a,e,t,r,[n,s]){let{layer:o,coordinate:i,triangle:c}=a,{geometry:l}=o.scene.header,h=l.triangles?Fe(
c,...i):oi(l,...i),u=t.ray(n,s),m=vs(o.scene,h,u)[1],[p,f]=vs(o.scene,m,u),d=bs(o.scene,f,p,e.parts.get("lonlat")),g=l.triangles?
d:ii(e.header,o,d);return{point:{position:p,index:g,values:ci(o.scene,r,d)},layer:o,place:d}}function oi({rows:a,columns:e,
shape:t},r,n){let s=(o,{size:i,before:c},l)=>T(o*i-.5-c,0,l-1);return[s(r,e,t[1]),s(n,a,t[0])]}function ii(a,{key:e},[t,
r]){let{pyramid:n,geometry:s,mesh:o,formula:i}=a,[c,l,h]=e,[u,m]=n?.shapes[0]??s.shape,p=o.tileCells*(n?.tileBlocks??0),
f=i?2**(n?.depth??0):1,d=(g,b,y)=>ft(g+b*p,c,y)/f;return[d(t,h,m),d(r,l,u)]}function vs(a,e,[t,r]){let{geometry:n}=a.header,
{data:s}=a.part("position"),o=a.cornersAt(e).map(([v])=>v),[i,c,l]=o.map(v=>R(K(n.frame,[...s.subarray(3*v,3*v+3)]),n.center)),
[h,u]=[E(c,i),E(l,i)],m=N(h,u),p=R(t,r,P(m,E(i,t))/P(m,r)),f=E(p,i),[d,g]=[N(f,u),N(h,f)].map(v=>P(v,m)/P(m,m));if(!(Math.
max(Math.abs(d),Math.abs(g))<ai)){let v=Ie(a,e);return[R(t,r,P(E(v,t),r)/P(r,r)),e]}if(n.triangles)return[p,Fe(Math.floor(
e[1]),d,Math.max(g,0))];let[b,y]=n.shape,x=(v,w)=>{let[M,A,S]=o.map(v);return T(M+d*(A-M)+g*(S-M),0,w-1)};return[p,[x(v=>v%
y,y),x(v=>Math.floor(v/y),b)]]}function ci(a,e,t){let{header:r,parts:n}=a,{scalars:s,geometry:o}=r,i=ys(a,t),c=o.triangles?
Math.floor(t[1]):i[0][0],[l,h,u]=e,m={},p=s.choices.map((f,d)=>({...f,number:d}));for(let f of[s,...p]){let d=a.scalarParts(
l,h,f),[g,b]=d.map(x=>n.get(x)?.data);if(f.name===null||f.name in m||!g||!b)continue;let y=x=>g[x]+u*(b[x]-g[x]);m[f.name]=
f.flat?y(c):yt(i,y)}return m}function Ms({sigma:a,radii:e},t,[r,n,s,o]){let i=a*t,c=2**Math.max(Math.floor(Math.log2(Math.SQRT2*i)),0),l=c>1?c**2/6+1/
12:0,h=i**2-l,[u,m]=[r,n].map(g=>Math.floor(g/c)*c),[p,f]=[s-u,o-m].map(g=>Math.ceil(g/c)+2),d=e*Math.sqrt(h);return{side:c,
first:[u,m],end:[s,o],columns:p,rows:f,variance:h,reach:d}}var wt=class{graphics;targets=[];columns=0;rows=0;constructor(e){
this.graphics=e}draw(e,t,r){let{graphics:n}=this,s=n.context,{side:o,first:i,end:c,columns:l,rows:h,variance:u,reach:m}=t,
[p,f]=[c[0]-i[0],c[1]-i[1]];this.fit(l,Math.max(f,h)),s.bindVertexArray(null);for(let y of[s.SCISSOR_TEST,s.DEPTH_TEST,s.
BLEND])s.disable(y);let[d,g]=this.targets,b={u_side:o,u_variance:u,u_reach:m};n.programs.use(e,{...b,u_from:i,u_along:[1,
0],u_count:p}),this.pass(d,l,f,r),n.programs.use(e,{u_from:[0,0],u_along:[0,1],u_count:f}),this.pass(g,l,h,d.texture),this.
bind("u_means",g.texture)}dispose(){for(let{frame:e,texture:t}of this.targets)this.graphics.free("Framebuffer",e),this.graphics.
free("Texture",t);this.targets=[],this.columns=this.rows=0}pass({frame:e},t,r,n){let s=this.graphics.context;this.bind("\
u_source",n),s.bindFramebuffer(s.FRAMEBUFFER,e),s.viewport(0,0,t,r),s.drawArrays(s.TRIANGLES,0,3)}bind(e,t){let r=this.graphics.
context;r.activeTexture(r.TEXTURE0+Q.indexOf(e)),r.bindTexture(r.TEXTURE_2D,t),r.activeTexture(r.TEXTURE0+Q.length)}fit(e,t){
if(this.columns>=e&&this.rows>=t)return;let[r,n]=[Math.max(e,this.columns),Math.max(t,this.rows)];this.dispose();let{graphics:s}=this,
o=s.context;this.targets=[0,1].map(()=>{let i=s.counted(o.createTexture());o.bindTexture(o.TEXTURE_2D,i),o.texStorage2D(
o.TEXTURE_2D,1,o.R32F,r,n),o.texParameteri(o.TEXTURE_2D,o.TEXTURE_MIN_FILTER,o.NEAREST),o.texParameteri(o.TEXTURE_2D,o.TEXTURE_MAG_FILTER,
o.NEAREST);let c=s.counted(o.createFramebuffer());return o.bindFramebuffer(o.FRAMEBUFFER,c),o.framebufferTexture2D(o.FRAMEBUFFER,
o.COLOR_ATTACHMENT0,o.TEXTURE_2D,i,0),{frame:c,texture:i}}),[this.columns,this.rows]=[r,n]}};var li=3,Es=5;function Ss({shape:a,triangles:e},t,r,n){let[s,o]=t.shape,i=new Int8Array(s*o).fill(e?0:Math.log2(n));for(let c=0;c<
r.length;c+=3){if(Number.isFinite(r[c]))continue;let[l,h]=[Math.floor(c/3/a[1]),c/3%a[1]];for(let u of[Math.floor((l-1)/
n),Math.floor(l/n)])for(let m of[Math.floor((h-1)/n),Math.floor(h/n)])u>=0&&u<s&&m>=0&&m<o&&(i[u*o+m]=0)}return i}function Ts({
shape:a,data:e},t,r,n,s){let[o,i]=a,c={...t.sight(r),planes:t.planes},l=new Int8Array(o*i).fill(-1),h=[1,1,-1,-1];for(let u=0;u<
l.length;u+=1){let[m,p]=[Math.floor(u/i),u%i],f=e.subarray(Es*u,Es*(u+1));if(n.some(([b,y,x])=>m>=b&&m<b+x&&p>=y&&p<y+x)||
!wr(c,f))continue;let g=Math.floor(Math.log2(li/Mr(c,f)));l[u]=Math.min(Math.max(g,0),s[u]),hi(t,f).forEach((b,y)=>h[y]=
y<2?Math.min(h[y],b):Math.max(h[y],b))}return{levels:l,box:h}}function hi(a,[e,t,r,n]){let[s,o,i]=a.axes,{parallel:c,position:l,
focal_point:h}=a.state,u=E([e,t,r],c?h:l),m=[-n,n].map(d=>a.at(R([e,t,r],i,d)).height);if(!(m[0]>0))return[-1,-1,1,1];let[
p,f]=[-n,n].map(d=>[P(u,s)/a.aspect,P(u,o)].map((g,b)=>m.map(y=>(g+d/(b?1:a.aspect))/y)));return[...p.map(d=>Math.min(...d)),
...f.map(d=>Math.max(...d))]}var ui=1024,As=["u_places","u_depths","u_colours","u_strides","u_below","u_texture"].map(a=>Q.indexOf(a)),Mt=class{width=0;height=0;graphics;means;target=null;key="";layers=[];seen=[];squares=0;constructor(e){
this.graphics=e,this.means=new wt(e)}draw({layers:e,camera:t,anchor:r,width:n,height:s}){let o=e.map(({scene:p,covered:f})=>[
p.number,p.version,f]),i=JSON.stringify([o,t.state,t.aspect,r,n,s]);if(i===this.key)return;Object.assign(this,{key:i,layers:e,
width:n,height:s});let c=this.graphics.context,{frames:l}=this.make(n,s),[{scene:h}]=e,u=Math.min(...e.map(({key:[p]})=>p))+
Math.log2(h.header.mesh.tileCells);this.seen=e.map(({scene:p,covered:f,key:[d]})=>{let g=p.doublings.map(b=>Math.max(Math.
min(b,u-d),0));return Ts(p.blocks,t,s,f,g)}),this.sendStrides(),c.bindFramebuffer(c.FRAMEBUFFER,l[0]),c.viewport(0,0,n,s),
c.disable(c.SCISSOR_TEST),c.enable(c.DEPTH_TEST),c.depthFunc(c.LESS),c.disable(c.BLEND),c.clearBufferuiv(c.COLOR,0,[0,0,
0,0]),c.clear(c.DEPTH_BUFFER_BIT);let m=z(h.header.geometry,t,r);h.bodies.hide(m,r),h.bodies.seeThrough(()=>this.triangles(
h.programs("place"),m,r),!1)}triangles(e,t,r,n={}){let{graphics:s,layers:o,seen:i}=this,c=s.context,{mesh:l,pyramid:h,geometry:u}=o[0].
scene.header,[m,p]=h?.shapes[0]??u.shape;this.bind(),c.bindVertexArray(null),o.forEach(({scene:f,key:[d,...g]},b)=>{let{
levels:y}=i[b],{columns:x,rows:v,shape:w,triangles:M}=f.header.geometry,[A,S]=g.map(L=>L*l.tileCells*(h?.tileBlocks??0)*
2**d);f.bindNodes(r),s.programs.use(e,{...n,u_matrix:t,u_layer:b+1,u_blocks:y.reduce((L,C,I)=>L|(C<0?0:1<<I),0),u_part:[
S,A,d],u_lastNode:[p-1,m-1,this.squares],u_closed:[Number(u.periodic[1]),Number(u.periodic[0])],u_blockCells:l.tileCells,
u_slicesSize:[x.size,v.size],u_padding:[x.before,v.before]}),M&&c.drawArrays(c.TRIANGLES,0,f.part("triangles").data.length);
let _=f.blocks.shape[1];y.forEach((L,C)=>{if(L<0||M)return;let I=[C%_,Math.floor(C/_)].map(U=>U*l.tileCells),[J,ae]=I.map(
(U,Z)=>Math.ceil(Math.min(l.tileCells,w[1-Z]-1-U)/2**L));s.programs.use(e,{u_block:[...I,L,J]}),c.drawArrays(c.TRIANGLES,
0,6*J*ae)})})}sum(e,t,r,n){let{graphics:s,width:o,height:i,target:c}=this,l=s.context,h=i-t-r;l.bindFramebuffer(l.FRAMEBUFFER,
c?.frames[1]??null),l.enable(l.SCISSOR_TEST),l.scissor(0,h,o,r),l.clearBufferfv(l.COLOR,1,[0,0,0,0]),this.pixels(e,h,r,n),
l.readPixels(0,0,1,1,l.RGBA,l.UNSIGNED_BYTE,new Uint8Array(4)),l.bindFramebuffer(l.FRAMEBUFFER,null)}colour(e,t){let{graphics:r,
layers:n,means:s,height:o,target:i}=this,c=r.context,[{scene:l}]=n;this.bind();let h=e===null?null:Ms(l.header.constants.
even,e,this.box);h&&s.draw(l.programs("blur"),h,i?.textures[5]??null),c.bindFramebuffer(c.FRAMEBUFFER,i?.frames[2]??null);
let u={u_first:h?.first??[0,0],u_side:h?.side??1};this.pixels(l.programs("colour"),0,o,m=>({...t(m),...u})),c.bindFramebuffer(
c.FRAMEBUFFER,null)}boxOf({box:e}){let{width:t,height:r}=this,[n,s,o,i]=e.map((l,h)=>(.5+.5*l)*(h%2?r:t));return[...[n,s].
map(l=>Math.max(Math.floor(l),0)),Math.min(Math.ceil(o),t),Math.min(Math.ceil(i),r)]}get box(){let e=this.seen.map(t=>this.
boxOf(t)).filter(([t,r,n,s])=>t<n&&r<s);return e.length?[0,1,2,3].map(t=>{let r=e.map(n=>n[t]);return t<2?Math.min(...r):
Math.max(...r)}):[0,0,1,1]}pixels(e,t,r,n){let{graphics:s,width:o,height:i}=this,c=s.context;c.viewport(0,0,o,i),c.enable(
c.SCISSOR_TEST),c.disable(c.DEPTH_TEST),c.disable(c.BLEND),c.bindVertexArray(null),this.layers.forEach(({scene:l},h)=>{let[
u,m,p,f]=this.boxOf(this.seen[h]),[d,g]=[u,Math.max(m,t)],[b,y]=[p-d,Math.min(f,t+r)-g];if(b<=0||y<=0)return;c.scissor(d,
g,b,y);let x=n(l);this.bind(),s.programs.use(e,{...x,u_layer:h+1}),c.drawArrays(c.TRIANGLES,0,3)})}show(e){let t=this.graphics.
context;this.bind(),t.bindVertexArray(null),this.graphics.programs.use(e,{u_bottom:0}),t.drawArrays(t.TRIANGLES,0,3)}at(e,t){
let{graphics:r,target:n,layers:s}=this,o=r.context,[i,c]=[(.5+.5*e)*this.width,(.5+.5*t)*this.height],l=T(Math.floor(i-.5),
0,this.width-2),h=T(Math.floor(c-.5),0,this.height-2),u=new Uint32Array(16);o.bindFramebuffer(o.FRAMEBUFFER,n?.frames[0]??
null),o.readPixels(l,h,2,2,o.RGBA_INTEGER,o.UNSIGNED_INT,u),o.bindFramebuffer(o.FRAMEBUFFER,null);let m=+(i>=l+1)+2*+(c>=
h+1),p=4*([m,m^1,m^2,m^3].find(g=>u[4*g+3])??m),[f,d]=new Float32Array(u.buffer,4*p,2);return u[p+3]?{layer:s[u[p+3]-1],
coordinate:[f,d],triangle:u[p+2]}:null}dispose(){let{graphics:e,target:t}=this;for(let r of t?.textures??[])e.free("Text\
ure",r);for(let r of t?.frames??[])e.free("Framebuffer",r);this.means.dispose(),this.target=null,this.key=""}sendStrides(){
let{layers:e,seen:t,target:r}=this,n=this.graphics.context,[{scene:s}]=e,{pyramid:o,geometry:i}=s.header,c=i.triangles?[
1,1]:o?.blocks[0]??s.blocks.shape;this.squares=Math.max(Math.ceil(Math.log2(Math.max(...c)/ui)),0);let l=2**-this.squares,
[h,u]=c.map(p=>Math.ceil(p*l)),m=new Uint8Array(h*u);e.forEach(({scene:p,key:[f,...d]},g)=>{let b=p.blocks.shape[1],y=2**
f*l;t[g].levels.forEach((x,v)=>{if(x<0||i.triangles)return;let[[w,M],[A,S]]=[Math.floor(v/b),v%b].map((_,L)=>{let C=(_+d[L]*
(o?.tileBlocks??0))*y;return[Math.floor(C),Math.min(Math.ceil(C+y),[h,u][L])]});for(let _=w;_<M;_+=1)for(let L=A+_*u;L<S+
_*u;L+=1)m[L]=Math.max(m[L],f+x)})}),n.activeTexture(n.TEXTURE0+As[3]),n.bindTexture(n.TEXTURE_2D,r?.textures[3]??null),
n.pixelStorei(n.UNPACK_ALIGNMENT,1),n.texImage2D(n.TEXTURE_2D,0,n.R8UI,u,h,0,n.RED_INTEGER,n.UNSIGNED_BYTE,m)}make(e,t){
let{target:r,graphics:n}=this;if(r&&r.width>=e&&r.height>=t)return r;let s=n.context,{key:o}=this,i={width:Math.max(e,r?.
width??0),height:Math.max(t,r?.height??0)};this.dispose();let c=[s.RGBA32UI,s.DEPTH_COMPONENT24,s.RGBA8,0,s.RGBA8,s.RGBA16F].
map(b=>{let y=n.counted(s.createTexture());return s.bindTexture(s.TEXTURE_2D,y),b&&s.texStorage2D(s.TEXTURE_2D,1,b,i.width,
i.height),s.texParameteri(s.TEXTURE_2D,s.TEXTURE_MIN_FILTER,s.NEAREST),s.texParameteri(s.TEXTURE_2D,s.TEXTURE_MAG_FILTER,
s.NEAREST),y}),[l,h]=[s.COLOR_ATTACHMENT0,s.COLOR_ATTACHMENT1],[u,m,p,,f,d]=c,g=[[[l,u],[s.DEPTH_ATTACHMENT,m]],[[l,f],[
h,d]],[[l,p]]].map(b=>{let y=n.counted(s.createFramebuffer());s.bindFramebuffer(s.FRAMEBUFFER,y);for(let[x,v]of b)s.framebufferTexture2D(
s.FRAMEBUFFER,x,s.TEXTURE_2D,v,0);return s.drawBuffers(b.map(([x])=>x).filter(x=>x!==s.DEPTH_ATTACHMENT)),y});return this.
key=o,this.target={frames:g,textures:c,...i}}bind(){let e=this.graphics.context;As.forEach((t,r)=>{e.activeTexture(e.TEXTURE0+
t),e.bindTexture(e.TEXTURE_2D,this.target?.textures[r]??null)}),e.activeTexture(e.TEXTURE0+Q.length)}};function _s(a,e){var t=e[0],r=e[1],n=e[2],s=e[3],o=e[4],i=e[5],c=t*s-r*n;return c?(c=1/c,a[0]=s*c,a[1]=-r*c,a[2]=-n*c,a[3]=
t*c,a[4]=(n*i-s*o)*c,a[5]=(r*o-t*i)*c,a):null}function Ps(a){return a[0]*a[3]-a[1]*a[2]}function Rs(a,e,t){var r=e[0],n=e[1],
s=e[2],o=e[3],i=e[4],c=e[5],l=t[0],h=t[1],u=t[2],m=t[3],p=t[4],f=t[5];return a[0]=r*l+s*h,a[1]=n*l+o*h,a[2]=r*u+s*m,a[3]=
n*u+o*m,a[4]=r*p+s*f+i,a[5]=n*p+o*f+c,a}var pi=14,fi=40,di=256;function Ls(a,e){a?.clearRect(0,0,e.width,e.height),a?.drawImage(e,0,0)}var gi=(a,e)=>a.getContext(
"2d",{alpha:e}),Et=class{viewer;content;graphics;canvas;pen;last=document.createElement("canvas");lastPen;lastCamera=null;coarse=document.
createElement("canvas");coarsePen;front=document.createElement("canvas");frontPen=this.front.getContext("2d");frontLook="";version=1;draftVersion=0;rowsDone=0;layers=[];isRefined=!1;fixed=4;isCoarse=!1;constructor(e,t){
this.viewer=e,this.content=t,this.graphics=e.graphics,this.canvas=e.canvas;let{canvas:r,last:n,coarse:s}=this,o=[r,n,s].
map(i=>gi(i,e.isClear??!1));[this.pen,this.lastPen,this.coarsePen]=o}restart(e=!1){e||(this.lastCamera=null),this.version+=
1,this.rowsDone=0}refine(){(this.rowsDone>=this.canvas.height||!this.content.isComing)&&(this.rowsDone=0),this.isRefined=
!0}resize(e,t){let{canvas:r,coarse:n,last:s}=this;n.width=r.width,n.height=r.height,this.coarsePen?.drawImage(r,0,0),r.width=
s.width=e,r.height=s.height=t,n.width>1&&this.pen?.drawImage(n,0,0,e,t)}dispose(){for(let e of[this.last,this.coarse,this.
front])e.width=e.height=0}draw(e,t,r){let n=this.isMoving;if(this.draftVersion!==this.version)return this.draft(e,t,n);if(n)
return!1;let s=!1;do s=this.strip(e,t)&&!this.isRefined;while(!s&&performance.now()<r);return s}get isMoving(){return this.
viewer.player.playing||this.viewer.isHeld}get leavesOut(){return this.isCoarse&&this.isMoving}arrange(e){this.isRefined=
!1,this.layers=this.content.arrange(e)}draft(e,t,r){let{width:n,height:s}=this.canvas,o=Number(this.viewer.settings.samples),
i=r?this.graphics.waiting.size+1:1;this.arrange(t);let c=e.price*this.factor(o),l=this.viewer.player.playing&&!this.viewer.
isHeld,h=An(c,this.fixed,n*s,o,l),u=Math.max(h/i,pi),m=Tn(c,this.fixed,n*s,o,u),p=Math.max(Math.round(n*m.scale),1),f=Math.
max(Math.round(s*m.scale),1);this.draftVersion=this.version;let d=m.scale<1?this.reuse():null;if(!d?.covers){let b=performance.
now();this.place(t,p,f);let y=this.sum(e,t,0,f,m.samples);this.show(t,!1,m.samples),this.fixed+=.5*(T(performance.now()-
b-y,.5,500)-this.fixed)}d&&this.pen&&(this.pen.imageSmoothingEnabled=!d.shifts,this.pen.setTransform(...d.matrix),Ls(this.
pen,this.last),this.pen.setTransform(1,0,0,1,0,0)),this.isCoarse=m.scale<1||m.samples<o;let g=!this.isCoarse&&!this.content.
smooth;return g&&this.complete(),this.drawLines(t),g&&!this.isRefined}strip(e,t){let{width:r,height:n}=this.canvas,s=Number(
this.viewer.settings.samples);if(this.rowsDone>=n&&(this.rowsDone=0),this.rowsDone===0&&(this.arrange(t),this.isRefined))
return!1;this.place(t,r,n);let o=e.price*this.factor(s),i=Math.min(n-this.rowsDone,_n(fi,o,r,s));return this.sum(e,t,this.
rowsDone,i,s),this.rowsDone+=i,this.rowsDone<n?!1:(this.show(t,this.content.smooth,s),this.complete(),this.drawLines(t),
!0)}drawLines(e){let{front:t,frontPen:r,graphics:n}=this,{camera:s,ratio:o}=this.viewer,{scene:i}=this.content,{width:c,
height:l}=this.canvas;if(!i||!s||!r)return;let{earth:h,bodies:u}=i;if(!h.lines.length&&!u.labels.length)return;let{state:m,
aspect:p}=s,f=JSON.stringify([m,p,c,l,h.lines,h.version]);if(f!==this.frontLook){let{anchor:d}=this.viewer.view(e,o),{canvas:g}=n;
g.width<c&&(g.width=c),g.height<l&&(g.height=l),t.width=c,t.height=l,h.drawLines({camera:s,anchor:d,width:c,height:l,ratio:o},
()=>{let b=g.height-l;r.drawImage(g,0,b,c,l,0,0,c,l)}),u.drawLabels(r,{camera:s,anchor:d,width:c,height:l,ratio:o}),this.
frontLook=f}this.pen?.drawImage(t,0,0)}complete(){let{camera:e,player:t}=this.viewer;this.rowsDone=this.canvas.height,this.
isCoarse=!1,this.draftVersion=this.version,Ls(this.lastPen,this.canvas),e&&!t.playing&&(this.lastCamera=new de(e.state,e.
limits,e.flat,e.aspect))}reuse(){let{lastCamera:e}=this,{camera:t}=this.viewer,{scene:r}=this.content;if(!r?.header.geometry.
planar||!t||!e||!t.state.parallel||!e.state.parallel)return null;let{geometry:n}=r.header,s=E(t.state.focal_point,n.center),
o=O(n.frame,s),[i,c]=[e,t].map(l=>z(n,l,o));return xi(i,c,this.canvas.width,this.canvas.height)}factor(e){let{settings:t,
player:r}=this.viewer;return t.motion!=="off"||r.varies&&r.playing?Pn(e):1}placeAt(e,t,r){let{places:n}=this.content;return this.
place(e,n?.width||this.canvas.width,n?.height||this.canvas.height),n?.at(t,r)??null}place(e,t,r){let{viewer:n,layers:s,content:o}=this,
{camera:i}=n;if(!i||!s.length)return;let{anchor:c}=n.view(e,this.density(r));o.places?.draw({layers:s,camera:i,anchor:c,
width:t,height:r})}density(e){return this.viewer.ratio*e/this.canvas.height}sum(e,t,r,n,s){let{places:o,scene:i}=this.content,
{camera:c}=this.viewer;if(!o||!i||!c)return 0;let{width:l,height:h}=o,u=this.viewer.view(t,this.density(h)),m=this.isDraft(
h,s),p=g=>(g.bindNodes(u.anchor),g.bindTextures(t[0],t[1]),{...this.values(g,i,c,u,s,m),...vn(g.header.geometry,c,u.anchor,
l,h)});e.warm||o.sum(e,r,1,p),e.warm=!0;let f=performance.now();o.sum(e,r,n,p);let d=performance.now()-f;return e.price=
Rn(e.price,d,l*n,s,this.factor(s)),d}isDraft(e,t){return t!==this.viewer.settings.samples||e!==this.canvas.height}colour(e,t,r){
let{scene:n}=this.content,{camera:s}=this.viewer;if(!n||!s)return;let{height:o}=e,i=this.viewer.view(t,this.density(o)),
c=this.isDraft(o,r),l=u=>this.values(u,n,s,i,r,c),h=yr(n.header,this.viewer.settings)?Number(l(n).u_grain):null;e.colour(
h,l)}show(e,t,r){let{places:n}=this.content;if(!n)return;this.colour(n,e,r);let{width:s,height:o}=n,{canvas:i}=this.graphics;
i.width<s&&(i.width=s),i.height<o&&(i.height=o);let c=t?di:o;for(let l=0;l<o;l+=c)this.render(e,l,Math.min(c,o-l),t)}render(e,t,r,n){
let{graphics:s,viewer:o}=this,{camera:i}=o,{scene:c,places:l}=this.content;if(!i||!c||!l)return;let h=s.context,{width:u,
height:m}=l,p=o.view(e,this.density(m));n?s.bindSmooth(u,r):h.bindFramebuffer(h.FRAMEBUFFER,null),h.viewport(0,-t,u,m),h.
enable(h.SCISSOR_TEST),h.scissor(0,0,u,r),h.enable(h.DEPTH_TEST),h.depthFunc(h.LESS),h.disable(h.BLEND),h.disable(h.CULL_FACE);
let[f,d,g]=c.header.background??[1,1,1];h.clearColor(f,d,g,o.isClear?0:1),h.clear(h.COLOR_BUFFER_BIT|h.DEPTH_BUFFER_BIT);
let b={camera:i,anchor:p.anchor,width:u,height:m,ratio:o.ratio};c.earth.drawGround(b);let{bodies:y}=c;y.draw(b,"opaque"),
y.seeThrough(()=>{if(!n)return l.show(c.programs("surface"));let x=z(c.header.geometry,i,p.anchor);l.triangles(c.programs(
"smooth"),x,p.anchor,{u_bottom:t})}),this.drawArrows(e,p,u,m),y.draw(b,"clear"),c.marks.draw({...b,ratio:p.density},o.settings,
e),n&&s.copySmooth(u,r),this.copy(u,m,t,r)}drawArrows(e,t,r,n){let{camera:s,settings:o}=this.viewer,{scene:i}=this.content;
if(!i||!s||!ke(i.header,o))return;let c={...s.sight(n/t.density),planes:s.planes},l=n!==this.canvas.height,h=this.layers.
map(u=>u.scene);for(let[u,m]of i.arrows.share(c,o,h)){let{arrows:p,header:f}=u,d=p.program(o,ht(f,o,t));if(!d||!m.length)
continue;u.bindTextures(e[0],e[1]);let g=u.scalarParts(e[0],e[1]),b=this.values(u,i,s,t,Number(o.samples),l);p.draw(d,m,
g,t.anchor,{...b,u_picture:[r,n]})}}values({header:e},{bodies:t},r,n,s,o){let{settings:i}=this.viewer,{columns:c,rows:l}=e.
geometry,h=e.scalars.name!==null&&ke(e,i)&&i.arrow_color==="scalars";return{...Un(e,{...i,samples:s},n),...o?Ln(i,s,n.density):
{},u_matrix:z(e.geometry,r,n.anchor),u_mapped:e.scalars.name!==null&&!h,u_plain:h,u_flat:!!e.scalars.flat,u_padding:[c.before,
l.before],u_colour:e.colour,u_lit:e.lighting,u_ground:e.background??[1,1,1],u_opacity:t.areBehind?1:e.opacity,u_toEye:O(
e.geometry.frame,k(r.axes[2],-1))}}copy(e,t,r,n){let{pen:s}=this;if(!s)return;let{canvas:o}=this.graphics,i=o.height-n,[
c,l]=[this.canvas.width,this.canvas.height/t];if(s.imageSmoothingEnabled=c!==e||l!==1,s.imageSmoothingEnabled){let{coarse:u,
coarsePen:m}=this;u.width=e,u.height=n,m?.drawImage(o,0,i,e,n,0,0,e,n),[o,i]=[u,0]}let h=(t-r-n)*l;s.clearRect(0,h,c,n*l),
s.drawImage(o,0,i,e,n,0,h,c,n*l)}},bi=4,yi=.3,Pr=1e-6,ks=(a,e)=>Rs([0,0,0,0,0,0],a,e),Os=a=>_s([0,0,0,0,0,0],a);function xi(a,e,t,r){
let[n,s]=[t/2,r/2],o=M=>ks([n,0,0,-s,n,s],[M[0],M[1],M[4],M[5],M[12],M[13]]),i=ks(o(e),Os(o(a))),c=Math.abs(Ps(i));if(!(c>
yi**2&&c<bi**2))return null;let[l,h,u,m,p,f]=Os(i),d=([M,A])=>Math.abs((l*M+u*A+p)/n-1)<1+Pr&&Math.abs((h*M+m*A+f)/s-1)<
1+Pr,g=[[0,0],[t,0],[0,r],[t,r]].every(d),[b,y,x,v]=i,w=Math.abs(b-1)+Math.abs(v-1)+Math.abs(y)+Math.abs(x)<Pr;if(w)for(let M of[
4,5])i[M]=Math.round(i[M]);return{matrix:i,covers:g,shifts:w}}var _t=4,Pt=class{surface;limits;sums;whole=[[]];last=null;constructor(e,t){this.surface=e,this.limits=t;let r=0;this.sums=
Float64Array.from({length:e.corners.length/_t},(n,s)=>r+=this.area(Rr(s)))}seen(e,t){return(!this.last||!this.covers(this.
last.wanted,[e,t]))&&(this.last={wanted:[e,t],seeds:this.make([e,t])}),this.last.seeds}position(e,t){let{nodes:r,corners:n}=this.
surface;return Ce(r,n.subarray(_t*e,_t*(e+1)),t,3)}point(e){let{frame:t,center:r}=this.surface.geometry;return R(K(t,e),
r)}covers([e,t],[r,n]){let{closer:s}=this.limits;return this.cornersOf(r).every(o=>s*t*At(e,o)<=n*At(r,o)&&this.sees(e,o,
0))}cornersOf({planes:e}){let{center:t,extent:r}=this.surface.geometry,n=c=>e[c].slice(0,3),s=N(n(0),n(2)),o=.5*r*F(s);return[
0,1].flatMap(c=>[2,3].flatMap(l=>[-1,1].map(h=>[c,l,h]))).map(([c,l,h])=>{let[u,m]=[n(c),n(l)],p=R(k(N(m,s),-e[c][3]),N(
s,u),-e[l][3]),f=N(u,m);return k(R(p,f,P(s,t)+h*o),1/P(f,s))})}sees(e,t,r){let n=r+this.limits.around*e.pixels*At(e,t);return e.
planes.every(s=>P(s,t)+s[3]>=-n*F(s))}make(e){let[t,r]=e,{limits:n,sums:s,whole:o}=this,{extent:i,center:c}=this.surface.
geometry,l=s[s.length-1]??0,h=t.eye?Math.max(F(E(c,t.eye))-.5*i,0):1,u=n.closer*r*Lr(t,h),m=i,p=o[0],f=null;for(let d=0;d<
n.mostOctaves;d+=1){let g=n.candidateArea*m**2;if(l<=n.mostCandidates*g)o[d+1]??=this.grown(p,this.spread(d,g),m),p=o[d+
1];else{f??=Array.from(s,(y,x)=>Rr(x)),f=this.divided(f.filter(y=>this.isNeeded(y,e,m)),g);let b=f.flatMap(y=>{let x=le(
y.key+d);return Tt(x)*g<this.area(y)?[this.candidate(y,x)]:[]});if(p=this.grown(p,b,m),!f.length)break}if(m<=u)break;m*=
n.octave}return p.filter(d=>{let g=this.point(d.position);return d.radius>=n.closer*r*At(t,g)&&this.sees(t,g,0)})}spread(e,t){
let{sums:r}=this,n=le(e+St),s=0;return Array.from({length:Math.floor((r[r.length-1]??0)/t)},(o,i)=>{let c=le(n+i),l=(i+Tt(
c))*t;for(;s<r.length-1&&r[s]<=l;)s+=1;return this.candidate(Rr(s),c)})}candidate({cell:e,low:t,size:r},n){let s=le(n+St),
o=le(s+St),i=[t[0]+r[0]*Tt(s),t[1]+r[1]*Tt(o)];return{cell:e,place:i,position:this.position(e,i),radius:1/0}}grown(e,t,r){
let n=r/this.limits.octave,s=new Rt(n);for(let l of e)s.add(l.position);for(let l of t)l.radius=s.distance(l.position);let o=t.
filter(({radius:l})=>l>=r).sort((l,h)=>h.radius-l.radius),i=new Rt(n),c=o.filter(l=>(l.radius=Math.min(l.radius,i.distance(
l.position)),l.radius<r?!1:(i.add(l.position),!0)));return[...e,...c]}isNeeded(e,[t,r],n){let{octave:s,closer:o,aroundRadii:i}=this.
limits,{cell:c,low:l,size:h}=e,u=this.point(this.position(c,[l[0]+.5*h[0],l[1]+.5*h[1]])),[m,p]=this.sides(e),f=.5*(F(m)+
F(p)),d=Math.max(Is(t,u)-f,0);return!(n<s*o*r*Lr(t,d))&&this.sees(t,u,f+i*n)}divided(e,t){let r=e.filter(o=>this.area(o)>
t);if(!r.length)return e;let n=r.map(o=>{let[i,c]=this.sides(o),l=F(c)>F(i)?1:0,h=[...o.size];h[l]*=.5;let u=[...o.low];
return u[l]+=h[l],[{...o,size:h,key:le(o.key+St)},{...o,size:h,low:u,key:le(o.key+vi)}]}),s=e.filter(o=>this.area(o)<=t);
return this.divided([...s,...n.map(([o])=>o),...n.map(([,o])=>o)],t)}sides({cell:e,low:t,size:r}){let n=(s,o)=>this.position(
e,[t[0]+r[0]*s,t[1]+r[1]*o]);return[E(n(1,.5),n(0,.5)),E(n(.5,1),n(.5,0))]}area(e){return F(N(...this.sides(e)))}};function Ce(a,e,[
t,r],n){let s=[(1-r)*(1-t),(1-r)*t,r*(1-t),r*t],o=new Array(n).fill(0);for(let i=0;i<_t;i+=1)for(let c=0;c<n;c+=1)o[c]+=
s[i]*a[n*e[i]+c];return o}var Rt=class{most;cubes=new Map;constructor(e){this.most=e}cube(e){return e.map(t=>Math.floor(
t/this.most))}add(e){let t=Ns(...this.cube(e)),r=this.cubes.get(t);r?r.push(e):this.cubes.set(t,[e])}distance(e){let[t,r,
n]=this.cube(e),s=this.most;for(let o=0;o<27;o+=1){let i=Ns(t+o%3-1,r+Math.floor(o/3)%3-1,n+Math.floor(o/9)-1);for(let c of this.
cubes.get(i)??[])s=Math.min(s,F(E(e,c)))}return s}},St=2654435769,vi=2246822507,wi=[739982445,695872825],Fs=15;function Ns(a,e,t){
return Math.imul(a,2376512323)^Math.imul(e,3625334849)^Math.imul(t,3407524639)}function le(a){let e=a>>>0;for(let t of wi)
e=Math.imul(e^e>>>Fs,t)>>>0;return(e^e>>>Fs)>>>0}var Tt=a=>a/2**32;function Rr(a){return{cell:a,low:[0,0],size:[1,1],key:le(
a)}}var Is=({eye:a},e)=>a?F(E(e,a)):1,Lr=({halfHeight:a,pixels:e},t)=>2*a/e*t,At=(a,e)=>Lr(a,Is(a,e));var Vs=[[0,3],[1,2],[2,3],[3,2],[4,3],[5,1]],Cs=4,Mi=Vs.reduce((a,[,e])=>a+e,0),Ei=(a,e)=>a.length===e.length&&a.every((t,r)=>t===
e[r]),Us=({tile:a})=>a?.[0]??1/0,Lt=class{graphics;header;parts;seeds=null;array=null;buffer=null;known=null;last=null;drawn=null;constructor(e,t,r){
this.graphics=e,this.header=t,this.parts=r}program(e,t){let{shaders:r,geometry:n}=this.header;if(!ke(this.header,e))return null;
let s=t&&!n.triangles?["FLOWTEX_CELLS"]:[];return this.graphics.programs.get(r.arrowVertex,r.arrowFragment,...s)}share(e,t,r){
let{header:n,last:s}=this;this.seeds??=new Pt(this.surface,n.constants.arrows);let o=this.seeds.seen(e,xr(n,t));if(s?.seeds===
o&&Ei(r,s.layers))return s.shared;let{corners:i}=this.surface,c=o.map(({cell:u,place:m,radius:p})=>{let f=i.subarray(4*u,
4*u+4);return{corners:f,place:m,radius:p,cell:n.geometry.triangles?u:f[0]}}),l=new Map(r.map(u=>[u,[]])),h=[...r].sort((u,m)=>Us(
u)-Us(m));for(let u of c)for(let m of h){let p=m.tile?this.inTile(u,m,m.tile):u;if(p){l.get(m)?.push(p);break}}return this.
last={seeds:o,layers:r,shared:l},l}draw(e,t,r,n,s){let{graphics:o}=this,i=o.context;this.array??=this.make(),i.bindVertexArray(
this.array);let{name:c,low:l,high:h,log:u}=this.header.scalars,m=r.map(f=>this.parts.get(f)?.digest),p=JSON.stringify([n,
r,m,c,l,h,u]);(this.drawn?.placed!==t||this.drawn.key!==p)&&(i.bindBuffer(i.ARRAY_BUFFER,this.buffer),i.bufferData(i.ARRAY_BUFFER,
this.numbers(t,r,n),i.DYNAMIC_DRAW),this.drawn={placed:t,key:p}),o.programs.use(e,s),i.enable(i.BLEND),i.blendFuncSeparate(
i.SRC_ALPHA,i.ONE_MINUS_SRC_ALPHA,i.ZERO,i.ONE),i.depthMask(!1),i.drawArraysInstanced(i.TRIANGLE_STRIP,0,2*(this.header.
constants.arrows.pieces+1),t.length),i.depthMask(!0),i.disable(i.BLEND),i.bindVertexArray(null)}forget(){this.known=this.
seeds=this.last=this.drawn=null}dispose(){this.graphics.free("Buffer",this.buffer),this.graphics.free("VertexArray",this.
array),this.array=this.buffer=null,this.forget()}inTile({corners:e,place:t,radius:r},n,[s,o,i]){let{geometry:c,pyramid:l,
mesh:h}=this.header;if(!l||c.triangles)return null;let u=h.tileCells*l.tileBlocks,[m,p]=n.header.geometry.shape,f=c.shape[1],
d=(x,v,w,M)=>{let A=l.shapes[0][v],S=Gn(ft(x,l.depth,A),s,A)-w*u,_=Math.min(Math.max(Math.floor(S),0),M-1);return S<0||S>
M?null:[_,S-_]},g=d(e[0]%f+t[0],1,i,p-1),b=d(Math.floor(e[0]/f)+t[1],0,o,m-1);if(!g||!b||n.parts.get("cells")?.data[b[0]*
(p-1)+g[0]]===0)return null;let y=b[0]*p+g[0];return{corners:[y,y+1,y+p,y+p+1],place:[g[1],b[1]],radius:r,cell:y}}make(){
let e=this.graphics.context,t=this.graphics.counted(e.createVertexArray());this.buffer=this.graphics.counted(e.createBuffer()),
e.bindVertexArray(t),e.bindBuffer(e.ARRAY_BUFFER,this.buffer);let r=0;for(let[n,s]of Vs)e.enableVertexAttribArray(n),e.vertexAttribPointer(
n,s,e.FLOAT,!1,Mi*Cs,r),e.vertexAttribDivisor(n,1),r+=s*Cs;return t}numbers(e,t,r){let{geometry:n,scalars:s}=this.header,
o=t.map(h=>this.parts.get(h)?.data??new Float32Array),i=bt(o,s),c=this.nodes,l=n.triangles?null:Yn(n);return Float32Array.
from(e.flatMap(({corners:h,place:u,radius:m,cell:p})=>{let[f,d]=u,[g,b,y,x]=Array.from(h,w=>[...c.subarray(3*w,3*w+3)]),
v=N(E(R(b,x),R(g,y)),E(R(y,x),R(g,b)));return[...E(Ce(c,h,u,3),r),...l?Ce(l,h,u,2):[f*(1-d),d],...V(v),...s.flat?i.subarray(
2*p,2*p+2):Ce(i,h,u,2),...Array.from(h).slice(0,3),m]}))}get nodes(){return this.parts.get("position")?.data??new Float32Array}get surface(){
return this.known??={geometry:this.header.geometry,nodes:this.nodes,corners:this.corners()}}corners(){let{geometry:e}=this.
header,[t,r]=e.shape,n=[];if(e.triangles){let o=this.parts.get("triangles")?.data??[];for(let i=0;i<o.length;i+=3)n.push(
o[i],o[i+1],o[i+2],o[i+2]);return Uint32Array.from(n)}let s=this.parts.get("cells")?.data;for(let o=0;o<(t-1)*(r-1);o+=1){
if(s&&!s[o])continue;let i=o+Math.floor(o/(r-1));n.push(i,i+1,i+r,i+r+1)}return Uint32Array.from(n)}};var Ue=["bodyPoints","bodyNormals","bodyColours","bodyFaces","bodyPieces"],Ds=8,[Si,Ti]=[24,8],Ae=[1,2],Ai=.2;function Ve(a,e,t){
let r=a.constructor,n=new r(t*e.length);for(let s=0;s<e.length;s+=1)for(let o=0;o<t;o+=1)n[t*s+o]=a[t*e[s]+o];return n}function _i({
geometry:a,bodies:e},t){let[r,n,s]=t.axes,o=(e?.lights??[]).slice(0,Ds),i=o.map(({way:l,turns:h})=>{let u=R(R(k(r,l[0]),
n,l[1]),s,-l[2]);return O(a.frame,h?u:l)}),c=l=>Float32Array.from({length:3*Ds},(h,u)=>l.flat()[u]??0);return{u_lightWays:c(
i),u_lightColours:c(o.map(({color:l})=>l))}}var kt=class{graphics;header;parts;drawn=null;constructor(e,t,r){this.graphics=
e,this.header=t,this.parts=r}get labels(){return this.header.bodies?.labels??[]}get runs(){let{bodies:e}=this.header;return e&&
Ue.every(t=>this.parts.has(t))?e.runs:[]}get areBehind(){return this.runs.length>0&&this.header.opacity<1}get programs(){
let{programs:e}=this.graphics,{bodyVertex:t,bodyFragment:r,lineVertex:n,lineFragment:s}=this.header.shaders;return[e.get(
t,r),e.get(n,s,"FLOWTEX_BODY"),e.get(t,r,"FLOWTEX_HIDING")]}get isReady(){return!this.runs.length||this.programs.every(({
ready:e})=>e)}dispose(){let{drawn:e,graphics:t}=this;if(e){for(let r of e.buffers)t.free("Buffer",r);t.free("VertexArray",
e.faces),t.free("VertexArray",e.pieces),this.drawn=null}}seeThrough(e,t=this.areBehind){if(!this.runs.length)return e();
let r=this.graphics.context;r.enable(r.POLYGON_OFFSET_FILL),r.polygonOffset(Ae[0],Ae[0]),t&&(r.enable(r.BLEND),r.blendColor(
0,0,0,this.header.opacity),r.blendFuncSeparate(r.CONSTANT_ALPHA,r.ONE_MINUS_CONSTANT_ALPHA,r.ZERO,r.ONE)),e(),r.disable(
r.BLEND),r.disable(r.POLYGON_OFFSET_FILL)}draw({camera:e,anchor:t,width:r,height:n,ratio:s},o){let i=o==="clear",c=this.
runs.filter(({clear:A})=>A===i);if(!c.length)return;let{header:l,graphics:h}=this,{geometry:u}=l,m=h.context,[p,f]=this.
programs,d=this.drawn??=this.make(),g=z(u,e,t),[b,y,x,v]=e.eye,w=O(u.frame,E([b,y,x],k(u.center,v)));i&&(m.enable(m.BLEND),
m.blendFuncSeparate(m.SRC_ALPHA,m.ONE_MINUS_SRC_ALPHA,m.ZERO,m.ONE),m.depthMask(!1)),h.programs.use(p,{u_matrix:g,u_anchor:t,
u_eye:[...E(w,k(t,v)),v],..._i(l,e)}),m.bindVertexArray(d.faces),m.enable(m.POLYGON_OFFSET_FILL),m.polygonOffset(Ae[1],Ae[1]);
for(let{faces:[A,S],ambient:_,diffuse:L}of c)S&&(h.programs.use(p,{u_ambient:_,u_diffuse:L}),m.drawElements(m.TRIANGLES,
3*S,m.UNSIGNED_INT,12*A));m.disable(m.POLYGON_OFFSET_FILL);let M={u_matrix:g,u_anchor:t,u_picture:[r,n],u_horizon:[0,0,0,
1]};h.programs.use(f,M),m.bindVertexArray(d.pieces);for(let{pieces:[A,S],width:_}of c)if(S){h.programs.use(f,{u_width:_*
s});for(let[L,C,I,J,ae]of[[d.ends,3,m.FLOAT,Si,0],[d.colours,4,m.UNSIGNED_BYTE,Ti,2]]){m.bindBuffer(m.ARRAY_BUFFER,L);for(let U of[
0,1])m.vertexAttribPointer(ae+U,C,I,C===4,J,J*(A+U/2))}m.drawArraysInstanced(m.TRIANGLE_STRIP,0,4,S)}m.bindVertexArray(null),
m.depthMask(!0),m.disable(m.BLEND)}hide(e,t){let{runs:r,graphics:n}=this;if(!r.length)return;let s=n.context,o=this.drawn??=
this.make();s.enable(s.POLYGON_OFFSET_FILL),s.polygonOffset(Ae[1],Ae[1]),n.programs.use(this.programs[2],{u_matrix:e,u_anchor:t}),
s.bindVertexArray(o.faces);for(let{faces:[i,c],clear:l}of r)l||s.drawElements(s.TRIANGLES,3*c,s.UNSIGNED_INT,12*i);s.disable(
s.POLYGON_OFFSET_FILL),s.bindVertexArray(null)}drawLabels(e,{camera:t,anchor:r,width:n,height:s,ratio:o}){let{geometry:i}=this.
header,c=z(i,t,r);for(let{text:l,position:h,size:u,color:m,plate:p}of this.labels){let f=E(O(i.frame,E(h,i.center)),r),[
d,g,,b]=[0,1,2,3].map(S=>c[S]*f[0]+c[4+S]*f[1]+c[8+S]*f[2]+c[12+S]);if(b<=0)continue;let[y,x]=[(.5+.5*d/b)*n,(.5-.5*g/b)*
s],v=u*o,w=Ai*v;e.font=`600 ${v}px system-ui, sans-serif`,e.textBaseline="middle";let[M,A]=[e.measureText(l).width+2*w,v+
2*w];e.fillStyle=Bs(p),e.beginPath(),e.roundRect(y,x-A,M,A,w),e.fill(),e.fillStyle=Bs(m),e.fillText(l,y+w,x-.5*A)}}make(){
let{graphics:e,parts:t}=this,r=e.context,[n,s,o,i,c]=Ue.map(b=>t.get(b)?.data??[]),l=()=>{let b=e.counted(r.createVertexArray());
return r.bindVertexArray(b),b},h=(b,y=r.ARRAY_BUFFER)=>{let x=e.counted(r.createBuffer());return r.bindBuffer(y,x),r.bufferData(
y,b,r.STATIC_DRAW),x},u=l(),p=[[n,3,r.FLOAT],[s,3,r.BYTE],[o,4,r.UNSIGNED_BYTE]].map(([b,y,x],v)=>{let w=h(b);return r.enableVertexAttribArray(
v),r.vertexAttribPointer(v,y,x,x!==r.FLOAT,0,0),w});p.push(h(i,r.ELEMENT_ARRAY_BUFFER));let f=l(),d=h(Ve(n,c,3)),g=h(Ve(
o,c,4));for(let b=0;b<4;b+=1)r.enableVertexAttribArray(b),r.vertexAttribDivisor(b,1);return r.bindVertexArray(null),{faces:u,
pieces:f,ends:d,colours:g,buffers:[...p,d,g]}}};function Bs([a,e,t,r=1]){return`rgb(${[a,e,t].map(n=>Math.round(255*n)).
join(" ")} / ${r})`}var Ot=["land","missing"],Pi=.18;function Hs({background:a,earth:e}){let t=a??[1,1,1],r=e?.missingShare??0,n=P(t.map(s=>s**
2.2),[.2126,.7152,.0722])>=Pi?0:1;return t.map(s=>s*(1-r)+n*r)}var js=1e30,zs=65535,Gs=256;function Ri(a,{low:e,size:t}){let r=[],n=[0,0,0];for(let s=0;s<a.length;s+=4){a[s+3]&&r.push(
[]);let o=n.map((i,c)=>(n[c]=n[c]+a[s+c]&zs,e[c]+n[c]/zs*t[c]));r[r.length-1].push(o)}return r}function Li(a,e){return e?
a.flatMap(t=>{let r=0,n=t.filter((s,o)=>{let i=r;return o&&(r+=Math.hypot(...s.map((l,h)=>l-t[o-1][h]))),Math.floor(r/e)>
Math.floor(i/e)||o===0||o===t.length-1});return r<e?[]:[n]}):a}function ki(a,e){let t=a.reduce((s,o)=>s+o.length+1,0),r=new Float32Array(
3*t).fill(js),n=0;for(let s of a){n+=3;for(let o of s)for(let i=0;i<3;i+=1)r[n++]=o[i]-e[i]}return r}function Oi(a){let e=[],
t=a.length/3-1;for(let r=0;r<t;r+=Gs){let n=Math.min(Gs,t-r),[s,o]=[[1/0,1/0,1/0],[-1/0,-1/0,-1/0]];for(let l=3*r;l<3*(r+
n+1);l+=1)a[l]!==Math.fround(js)&&(s[l%3]=Math.min(s[l%3],a[l]),o[l%3]=Math.max(o[l%3],a[l]));let i=s.map((l,h)=>(l+o[h])/
2),c=Math.hypot(...s.map((l,h)=>(o[h]-l)/2));e.push({first:r,count:n,middle:i,radius:c})}return e}function Fi(a,e){let t=[];
for(let{first:r,count:n,middle:[s,o,i],radius:c}of a){let l=([u,m,p,f])=>u*s+m*o+p*i+f<-c*Math.hypot(u,m,p);if(e.some(l))
continue;let h=t[t.length-1];h&&h[0]+h[1]===r?h[1]+=n:t.push([r,n])}return t}var Ws=12,$s=2;var Ft=class{version=0;graphics;header;parts;drawn=new Map;constructor(e,t,r){this.graphics=e,this.header=t,this.parts=r}forget(e){
this.version+=1;for(let t of e==="position"?Ot:[e])this.drop(t)}dispose(){for(let e of[...this.drawn.keys()])this.drop(e)}drop(e){
let t=this.drawn.get(e);if(t){for(let r of t.buffers)this.graphics.free("Buffer",r);this.graphics.free("VertexArray",t.array),
this.drawn.delete(e)}}get lines(){let{earth:e}=this.header;return e?Zr.filter(t=>e[t]&&this.parts.has(t)):[]}drawLines(e,t){
let{header:r,graphics:n}=this,{earth:s,shaders:o}=r,i=n.programs.get(o.lineVertex,o.lineFragment);if(!s||!i.ready)return;
let c=n.context,{camera:l,anchor:h,width:u,height:m,ratio:p}=e;c.bindFramebuffer(c.FRAMEBUFFER,null),c.viewport(0,0,u,m),
c.enable(c.SCISSOR_TEST),c.scissor(0,0,u,m),c.disable(c.DEPTH_TEST),c.enable(c.BLEND),c.blendEquation(c.MAX),c.clearColor(
0,0,0,0);let f=this.horizon(l),g=[...l.planes,...f?[f]:[]].map(w=>this.localPlane(w,h)),b=2*l.height*p/m,y=T(Math.sqrt(m/
p/s.usualHeight),...s.widthRange),x=s.spacingPixels*b,v=s.spacings.find(w=>w<=x)??0;for(let{option:w,color:M,opacity:A,width:S}of s.
strokes){if(!this.lines.includes(w))continue;c.clear(c.COLOR_BUFFER_BIT);let _=this.take(w,h,()=>this.linesOf(w,h,v),v);
n.programs.use(i,{u_matrix:z(r.geometry,l,h),u_picture:[u,m],u_width:S*y*p,u_lineColour:[...M,A],u_horizon:f?g[g.length-
1]:[0,0,0,1]}),c.bindVertexArray(_.array),c.bindBuffer(c.ARRAY_BUFFER,_.buffers[0]);for(let[L,C]of Fi(_.groups,g)){for(let I=0;I<
$s;I+=1)c.vertexAttribPointer(I,3,c.FLOAT,!1,Ws,(L+I)*Ws);c.drawArraysInstanced(c.TRIANGLE_STRIP,0,4,C)}t()}c.bindVertexArray(
null),c.blendEquation(c.FUNC_ADD),c.disable(c.BLEND)}get isReady(){let{lineVertex:e,lineFragment:t}=this.header.shaders,
{earth:r}=this.header;return r?.land&&(r.map===null&&r.below&&!this.groundProgram("FLOWTEX_GLOBE").ready||this.hasCells&&
!this.groundProgram(...this.roundness).ready)?!1:!this.lines.length||this.graphics.programs.get(e,t).ready}groundProgram(...e){
let{groundVertex:t,groundFragment:r}=this.header.shaders;return this.graphics.programs.get(t,r,...e)}get hasCells(){return Ot.
some(e=>this.parts.has(e))}get roundness(){return this.header.earth?.map===null?["FLOWTEX_ROUND"]:[]}drawGround({camera:e,
anchor:t}){let{header:r,graphics:n}=this,{earth:s,geometry:o}=r;if(!s?.land)return;let i=s.map===null,c=Ot.filter(p=>this.
parts.has(p)),l=n.context,h={u_matrix:z(o,e,t),u_ground:r.background??[1,1,1],u_lit:r.lighting,u_toEye:O(o.frame,k(e.axes[2],
-1))},u=Hs(r);if(i&&s.below){let p=this.groundProgram("FLOWTEX_GLOBE");if(!p.ready)return;n.programs.use(p,{...h,u_colour:u,
...this.disc(e,s.radius,t)}),l.bindVertexArray(this.take("disc",t,()=>this.emptyArray()).array),l.drawArrays(l.TRIANGLE_STRIP,
0,4)}let m=this.groundProgram(...this.roundness);if(!c.length||!m.ready)return l.bindVertexArray(null);l.depthMask(!1);for(let p of c){
let f=p==="land"?s.land:u,d=E(O(o.frame,k(o.center,-1)),t);n.programs.use(m,{...h,u_colour:f,...i&&{u_middle:d}});let g=this.
take(p,t,()=>this.cellsOf(p,t));l.bindVertexArray(g.array),l.drawElements(l.TRIANGLES,g.count,l.UNSIGNED_INT,0)}l.depthMask(
!0),l.bindVertexArray(null)}horizon(e){let{earth:t}=this.header;if(!t||t.map)return null;let{radius:r}=t,[n,s,o,i]=e.eye,
c=i*Math.hypot(n,s,o);return[...V([n,s,o]),c?-(r**2)/c:0]}localPlane(e,t){let{frame:r,center:n}=this.header.geometry,s=e.
slice(0,3),o=O(r,s);return[...o,P(o,t)+P(s,n)+e[3]]}disc(e,t,r){let{frame:n,center:s}=this.header.geometry,[o,i,c,l]=this.
horizon(e)??[0,0,1,0],h=[o,i,c],u=Math.sqrt(Math.max(t**2-l**2,0)),m=V(N(e.axes[1],h)),p=N(h,m),f=R(k(h,-l),s,-1);return{
u_middle:E(O(n,f),r),u_aside:k(O(n,m),u),u_upward:k(O(n,p),u),u_away:e.state.parallel?0:F(e.state.position)/t}}take(e,t,r,n=0){
let s=this.drawn.get(e);if(s&&String([s.anchor,s.spacing])===String([t,n]))return s;this.drop(e);let o={...r(),anchor:t,
spacing:n};return this.drawn.set(e,o),o}emptyArray(){let{graphics:e}=this;return{array:e.counted(e.context.createVertexArray()),
buffers:[],anchor:[0,0,0],spacing:0,count:0,groups:[]}}buffer(e,t){let{graphics:r}=this,n=r.context,s=r.counted(n.createBuffer());
return n.bindBuffer(e,s),n.bufferData(e,t,n.STATIC_DRAW),s}linesOf(e,t,r){let n=this.graphics.context,{earth:s}=this.header,
o=this.parts.get(e)?.data??[],i=s?Ri(o,s):[],c=ki(Li(i,r),t),l={...this.emptyArray(),groups:Oi(c)};n.bindVertexArray(l.array),
l.buffers=[this.buffer(n.ARRAY_BUFFER,c)];for(let h=0;h<$s;h+=1)n.enableVertexAttribArray(h),n.vertexAttribDivisor(h,1);
return l}cellsOf(e,t){let r=this.graphics.context,n=this.parts.get(e),s=this.parts.get("position"),o=this.emptyArray();if(!n||
!s)return o;let i=this.header.geometry.triangles?n.data:Ni(n);r.bindVertexArray(o.array);let c=gt(s.data,t);return o.buffers=
[this.buffer(r.ARRAY_BUFFER,c),this.buffer(r.ELEMENT_ARRAY_BUFFER,i)],o.count=i.length,r.enableVertexAttribArray(0),r.vertexAttribPointer(
0,3,r.FLOAT,!1,0,0),o}};function Ni({data:a,shape:[e,t]}){let r=[];for(let n=0;n<e*t;n+=1){if(!a[n])continue;let s=n+Math.
floor(n/t),o=s+t+1;r.push(s,s+1,o+1,s,o+1,o)}return Uint32Array.from(r)}var[Ii,Ci]=[.01,.2],[ne,Xs]=[4,24],Ys=9;function qs(a,e,t){let r={lines:{"from saddle":[],"to saddle":[],"stable orbit":[],
"unstable orbit":[]},points:[]};for(let s=0;s<Math.min(a.length/ne,t.points);s+=1){let o=a[ne*s+3];(r.points[o]??=[]).push(
...[0,1,2].map(i=>a[ne*s+i]))}let n=NaN;for(let s=0;s<e.length/ne;s+=1){let o=e[ne*s+3];if(o>=tt.saddle*t.saddles)continue;
let i=o&tt.orbit?["stable orbit","unstable orbit"]:["from saddle","to saddle"],c=r.lines[i[o&tt.leaving?0:1]];o!==n&&c.push(
[]),n=o,c[c.length-1].push(...[0,1,2].map(l=>e[ne*s+l]))}return r}function Ui(a,e){let t=[];for(let r=0;r<a.length;r+=ne)
a[r+3]===e&&t.push(a[r],a[r+1],a[r+2]);return Float32Array.from(t)}function De(a,e=!1){let t=Float32Array.from(a.flat());
if(e)return Ve(t,Array.from({length:2*t.length/3},(s,o)=>o>>1),3);let r=[],n=0;for(let s of a){let o=s.length/3;for(let i=n;i<
n+o-1;i+=1)r.push(i,i+1);n+=o}return Ve(t,r,3)}var Nt=class{graphics;header;parts;array=null;buffer=null;drawn=null;constructor(e,t,r){
this.graphics=e,this.header=t,this.parts=r}kinds(e){let t=this.header.structure?.parts??[];return Object.keys(Me).filter(
r=>t.includes(r)&&Number(e[Me[r]])>0)}lacking(e,t){let r=kr(t);return this.kinds(e).flatMap(n=>this.parts.has(`${n}/${r}`)?
[]:[[n,r]])}get program(){let{lineVertex:e,lineFragment:t}=this.header.shaders;return this.graphics.programs.get(e,t,"FL\
OWTEX_BODY","FLOWTEX_MARK")}isReady(e){return!this.kinds(e).length||this.program.ready}shown(e,t,r){let s=this.kinds(e).
includes(r)?this.parts.get(`${r}/${kr(t)}`):void 0;return[s?Number(e[Me[r]]):0,s]}legend(e,t){let[r,n]=this.shown(e,t,"c\
ritical"),s=new Set;for(let m=0;m<Math.min(r,n?.shape[0]??0);m+=1)s.add(Number(n?.data[ne*m+3]));let{kinds:o=[],lines:i={},
nullclines:c=[]}=this.header.structure??{},[l,h]=this.shown(e,t,"separatrices"),u=Object.entries(qs([],h?.data??[],{points:0,
saddles:l}).lines).filter(([,m])=>m.length).map(([m])=>({name:m,color:i[m]}));return this.shown(e,t,"nullclines")[0]&&u.
push(...c),[...o.filter((m,p)=>s.has(p)),...u.map(m=>({...m,isLine:!0}))]}draw({camera:e,anchor:t,width:r,height:n,ratio:s},o,i){
let{header:c,graphics:l}=this,{structure:h,geometry:u}=c,m=h&&this.layers(h,o,i);if(!h||!m?.length)return;let p=l.context,
[f,d,g,b]=e.eye,y=O(u.frame,E([f,d,g],k(u.center,b))),x=s*T(Math.sqrt(n/s/h.usualHeight),...h.widthRange),v=b?1:e.distance/
Math.hypot(...y);p.bindVertexArray(this.array),p.enable(p.BLEND),p.blendFuncSeparate(p.SRC_ALPHA,p.ONE_MINUS_SRC_ALPHA,p.
ZERO,p.ONE),p.depthFunc(p.LEQUAL);let w=this.program;l.programs.use(w,{u_matrix:z(u,e,t),u_anchor:t,u_eye:[...E(y,k(t,b)),
b],u_picture:[r,n],u_horizon:[0,0,0,1]}),p.bindBuffer(p.ARRAY_BUFFER,this.buffer);for(let{first:M,count:A,color:S,width:_,
above:L}of m){let[C,I,J,ae=1]=S;l.programs.use(w,{u_width:_*x,u_nearer:Ii*v*(1+Ci*L)});for(let U of[0,1])p.vertexAttribPointer(
U,3,p.FLOAT,!1,Xs,Xs*(M+U/2)),p.vertexAttrib4f(2+U,C,I,J,ae);p.drawArraysInstanced(p.TRIANGLE_STRIP,0,4,A)}p.bindVertexArray(
null),p.depthFunc(p.LESS),p.disable(p.BLEND)}layers(e,t,r){let[[n,s],[o,i],[,c]]=["critical","separatrices","nullclines"].
map(w=>this.shown(t,r,w)),l=JSON.stringify([n,s?.digest,o,i?.digest,c?.digest,kr(r)]);if(this.drawn?.key===l)return this.
drawn.layers;let h=qs(s?.data??[],i?.data??[],{points:n,saddles:o}),{line:u,dot:m,rim:p,middle:f}=e,d=[],g=[],b=0,y=(w,M,A,S)=>{
let _=w.length/6;_&&d.push({first:b,count:_,color:M,width:A,above:S}),g.push(w),b+=_},x=e.nullclines.map((w,M)=>Ui(c?.data??
[],M));x.forEach(w=>y(w,p,u[0],0)),x.forEach((w,M)=>y(w,e.nullclines[M].color,u[1],1)),y(De(Object.values(h.lines).flat()),
p,u[0],1.5),Object.entries(h.lines).forEach(([w,M],A)=>y(De(M),e.lines[w],u[1],2+A));let v=e.kinds.map((w,M)=>h.points[M]??
[]);return y(De(v,!0),p,m[0],6),e.kinds.forEach(({color:w},M)=>y(De([v[M]],!0),w,m[1],7)),y(De(v.filter((w,M)=>e.kinds[M].
turns),!0),f,m[2],8),this.send(g),this.drawn={key:l,layers:d},d}send(e){let{graphics:t}=this,r=t.context;this.array??=t.
counted(r.createVertexArray()),this.buffer??=t.counted(r.createBuffer()),r.bindVertexArray(this.array),r.bindBuffer(r.ARRAY_BUFFER,
this.buffer),r.bufferData(r.ARRAY_BUFFER,Float32Array.from(e.flatMap(n=>[...n])),r.STATIC_DRAW);for(let n of[0,1])r.enableVertexAttribArray(
n),r.vertexAttribDivisor(n,1);r.bindVertexArray(null)}at({place:e,position:t,height:r},n,s,o){let{geometry:i,structure:c}=this.
header,[l,h]=this.shown(s,o,"critical"),u=2*n.height/Math.max(r,1),[m,p]=["",Ys];for(let f=0;f<Math.min(l,h?.shape[0]??0);f+=
1){let[d,g,b,y]=[0,1,2,3].map(M=>Number(h?.data[ne*f+M])),x=R(K(i.frame,[d,g,b]),i.center),v=n.project(x);if(!v||Math.hypot(
...E(x,t))>4*Ys*u)continue;let w=.5*r*Math.hypot((v[0]-e[0])*n.aspect,v[1]-e[1]);w<p&&([m,p]=[c?.kinds[y]?.name??"",w])}
return m}dispose(){this.graphics.free("Buffer",this.buffer),this.graphics.free("VertexArray",this.array),this.array=this.
buffer=this.drawn=null}};function kr([a,e,t]){return t<.5?a:e}var Vi={position:["nodes"],normal:["nodes"],cells:["cells"],triangles:["nodes","cells","scalar"],blocks:["cells"],cmap:[
"cmap"],image:["image"],step:["step"],scalars:["scalar"]},Ks=["padded","unit","open","nearest","rays"],Di=8*(4/3),Bi=2048,
Hi=["u_slices","u_slicesNext","u_image","u_stepImage","u_nodes"],zi=0,_e=class{graphics;header;parts;earth;bodies;arrows;marks;tile;anchor=[
0,0,0];version=0;resources=new Map;scalarSteps="";most=null;tracing="";wanted=[];number=zi+=1;constructor(e,t,r,n=null){
this.tile=n,this.graphics=e,this.header=t,this.parts=r,this.earth=new Ft(e,t,r),this.bodies=new kt(e,t,r),this.arrows=new Lt(
e,t,r),this.marks=new Nt(e,t,r)}isReady(e,t=!1){let r=[!1,!0].map(i=>this.arrows.program(e,i));return[...["place","blur",
"colour","surface","smooth","probe"].filter(i=>t||i!=="smooth").map(i=>this.programs(i).ready),this.earth.isReady,this.bodies.
isReady,this.marks.isReady(e)].every(Boolean)&&r.every(i=>i?.ready??!0)}missing(e,t){let{geometry:r,slices:n,scalars:s,image:o,
pyramid:i,formula:c}=this.header,{trace:l}=n,h=["mesh",...l?.parts??["position",...r.planar?[]:["normal"]]];i&&!c&&h.push(
"places"),this.header.bodies?.runs.length&&h.push(...Ue),r.triangles&&h.push("triangles","blocks");for(let u of new Set(
[e,t]))l?h.push(...ie(this.header,u).map(m=>`flow/${m}`)):h.push(`slices/${u}`),n.channels===2&&h.push(`extra/${u}`);return h.
push(...this.scalarParts(e,t)),s.name!==null&&h.push("cmap"),o&&h.push("image","step"),[...new Set(h)].filter(u=>!this.fits(
u))}lacking(e){let t=this.missing(e,e).map(r=>r.startsWith("flow/")?Y(r):e);return[...new Set(t)]}scalarParts(e,t,r=this.
header.scalars){let{name:n,steps:s,number:o}=r;if(n===null)return[];let i=o?`/${o}`:"";return(s>1?[e,t]:[0,0]).map(c=>`s\
calars/${c}${i}`)}fits(e){let t=this.parts.get(e);if(!t)return!1;let{geometry:r,slices:n,image:s,mesh:o}=this.header,i=r.
shape.map(u=>Math.max(Math.ceil((u-1)/o.tileCells),1)),c=n.trace?.nodes??[],h={flow:[...c,t.shape[2]],unit:c,padded:[...c.
map(u=>u+2),3],slices:[n.count,r.rows.size,r.columns.size,n.channels],position:[...r.shape,3],mesh:r.triangles?t.shape:[
...i,t.shape[2]],step:s?[...s.stepSize].reverse():[]}[e.split("/")[0]];return!h||String(h)===String(t.shape)}make(e,t){let{
slices:r,geometry:n}=this.header,{trace:s}=r;if(!s)return!0;let o=this.part("padded"),i=c=>this.key(["padded"],c,s);return this.
put("position",i("position"),()=>In(o,s,n.shape)),!n.planar&&!s.parts.includes("normal")&&this.put("normal",i("normal"),
()=>Cn(o,s,n.shape)),this.wanted=e,e.every(c=>this.trace(c,t))}prepare(){let{trace:e}=this.header.slices;e&&at(this.graphics,
this.header,e)}trace(e,t){let{graphics:r,header:n}=this,{trace:s,lags:o,sides:i}=n.slices,c=`slices/${e}`;if(!s||this.resources.
has(c))return!0;let l=ie(n,e).map(m=>`flow/${m}`),h=this.key([...l,...Ks],e,s,o,i,n.geometry.levels),u=null;if(!h||!r.common.
has(`slices ${h}`)){let{tracings:m}=r,p=h||`${this.number} ${e}`;this.tracing!==p&&this.stopTracing();let f=g=>this.parts.
get(g),d=m.get(p)??new ot(r,n,s,f,e);if(m.set(this.tracing=p,d),u=d.advance(t),!u)return!1;this.stopTracing()}return this.
take(c,"Texture",h,()=>u,()=>{}),!0}put(e,t,r){let{graphics:n,parts:s}=this;if(s.get(e)?.digest===t)return;let o=n.stock.
get(t)?.part??{...r(),digest:t};n.release(s.get(e)),s.set(e,n.hold(o)),this.forget(e)}isMade(e){return!this.missing(e[0],
e[e.length-1]).length&&(!this.header.slices.trace||this.isLoaded(e))}stopTracing(){this.graphics.tracings.get(this.tracing)?.
dispose(),this.graphics.tracings.delete(this.tracing),this.tracing=""}part(e){let t=this.parts.get(e);if(!t)throw new Error(
`the part "${e}" of the scene is missing`);return t}forget(e){let[t,r]=e.split("/");["position","cells","triangles"].includes(
t)&&this.arrows.forget();let n=["slices","extra","flow"].includes(t);!n&&t!=="scalars"&&(this.earth.forget(e),this.version+=
1,this.most=null),Ue.includes(t)&&this.bodies.dispose();for(let s of n?[`slices/${r}`]:Vi[t]??[])this.drop(s);Ks.includes(
t)&&(this.wanted=[],this.dropSlices(NaN,NaN))}drop(e){let t=this.resources.get(e);this.resources.delete(e),t&&(t.users-=
1,!t.users&&(this.graphics.free(t.kind,t.object),this.graphics.common.delete(t.key)))}dispose(){for(let e of[...this.resources.
keys()])this.drop(e);this.stopTracing(),this.earth.dispose(),this.bodies.dispose(),this.arrows.dispose(),this.marks.dispose()}key(e,...t){
let r=e.map(n=>this.parts.has(n)?this.part(n).digest:"none");return r.every(Boolean)?JSON.stringify([r,t]):""}take(e,t,r,n,s){
let o=this.resources.get(e);if(o)return o.object;let{graphics:i}=this,c=r&&`${e.split("/")[0]} ${r}`,l=c?i.common.get(c):
void 0,h=l?.object??i.counted(n()),u=l??{kind:t,object:h,count:0,key:c,users:0};return u.users+=1,this.resources.set(e,u),
l||(u.count=s(h)||0),c&&i.common.set(c,u),h}get blocks(){return this.part("mesh")}get doublings(){let{geometry:e,mesh:t}=this.
header;return this.most??=Ss(e,this.blocks,this.part("position").data,t.tileCells)}cornersAt(e){let{triangles:t,shape:r}=this.
header.geometry;return t?Qn(this.part("triangles").data,e):Jn(r,e)}isLoaded(e){return e.every(t=>this.resources.has(`sli\
ces/${t}`))}get tracedBytes(){let{slices:e,geometry:t}=this.header;return e.trace?[...this.resources.keys()].filter(n=>n.
startsWith("slices/")).length*Di*e.count*t.rows.size*t.columns.size:0}load(e){for(let t of e)this.slices(t)}bindNodes(e){
let t=this.graphics.context,{shape:r,triangles:n,planar:s}=this.header.geometry;e.some((u,m)=>u!==this.anchor[m])&&this.
drop("nodes"),this.anchor=e;let[o,i]=this.nodesSize,c=this.texture("nodes",this.key(["position","normal"],i,e),u=>{lr(t,
i,o),t.bindTexture(t.TEXTURE_2D_ARRAY,u);let m=new Float32Array((s?3:6)*i*o);m.set(gt(this.part("position").data,e)),s||
m.set(Kn(this.part("normal").data),3*i*o);let p=[i,o,s?1:2];t.texImage3D(t.TEXTURE_2D_ARRAY,0,t.RGB32F,...p,0,t.RGB,t.FLOAT,
m),Js(t,t.TEXTURE_2D_ARRAY)}),l=()=>this.parts.get("cells")?.data??Uint8Array.of(1),h=n?this.table("cells",this.key(["tr\
iangles","blocks"]),t.RGBA32UI,Bi,()=>Zn(this.part("triangles").data,this.part("blocks").data)):this.table("cells",this.
key(["cells"],r),t.R8UI,this.parts.has("cells")?r[1]-1:1,l);this.bind("u_nodes",c),this.bind(n?"u_corners":"u_open",h)}get nodesSize(){
let{shape:e,triangles:t,rows:r,columns:n}=this.header.geometry;return t?[r.size,n.size]:e}bind(e,t){let r=this.graphics.
context;r.activeTexture(r.TEXTURE0+Q.indexOf(e)),r.bindTexture(Hi.includes(e)?r.TEXTURE_2D_ARRAY:r.TEXTURE_2D,t),r.activeTexture(
r.TEXTURE0+Q.length)}table(e,t,r,n,s){let o=this.graphics.context,i={[o.RGBA32UI]:[o.RGBA_INTEGER,o.UNSIGNED_INT,4],[o.R8UI]:[
o.RED_INTEGER,o.UNSIGNED_BYTE,1],[o.RG32F]:[o.RG,o.FLOAT,2],[o.RGBA32F]:[o.RGBA,o.FLOAT,4]},[c,l,h]=i[r];return this.texture(
e,t,u=>{let m=s(),p=Math.ceil(m.length/h/n);o.bindTexture(o.TEXTURE_2D,u),o.pixelStorei(o.UNPACK_ALIGNMENT,1);let f=Gi(m,
h*n*p);o.texImage2D(o.TEXTURE_2D,0,r,n,p,0,c,l,f),Js(o,o.TEXTURE_2D)})}shares(e,t){let{geometry:r,scalars:n}=this.header,
{shape:s}=r,o=this.scalarParts(e,t);return[this.key(["triangles",...new Set(o)],s,n.low,n.high,n.log),()=>bt(o.map(l=>this.
part(l).data),n)]}texture(e,t,r){let n=this.graphics.context;return this.take(e,"Texture",t,()=>n.createTexture(),r)}slices(e){
let{slices:t,geometry:r}=this.header,n=this.key([`slices/${e}`,`extra/${e}`],r.levels,t.extra);return this.texture(`slic\
es/${e}`,n,s=>{let o=this.part(`slices/${e}`),[i,c,l,h]=o.shape,u=o.data,m=this.parts.get(`extra/${e}`)?.data,p=c*l,f=d=>{
let g=u.subarray(d*p*h,(d+1)*p*h);if(h===4)return g;let b=new Uint16Array(4*p),y=t.extra.indexOf(d),x=y<0?null:m?.subarray(
y*p,(y+1)*p);for(let v=0;v<p;v+=1)b[4*v]=g[2*v],b[4*v+1]=g[2*v+1],x&&(b[4*v+3]=x[v]);return b};this.fill(s,{width:l,height:c,
layers:i,channels:4,levels:r.levels},f)})}programs(e){let{programs:t}=this.graphics,{vertex:r,place:n,fullVertex:s,even:o,
surface:i,...c}=this.header.shaders;return e==="place"?t.get(r,n):e==="smooth"?t.get(r,i,"FLOWTEX_SMOOTH"):e==="surface"?
t.get(s,i):e==="blur"?t.get(s,o):t.get(s,c[e])}texels(e,t){let{graphics:r,header:n}=this,s=r.context,{slices:o,geometry:i}=n,
c=i.columns.size,l=this.slices(e),h=()=>{s.activeTexture(s.TEXTURE0),s.bindTexture(s.TEXTURE_2D_ARRAY,l),s.bindVertexArray(
null);let p=t.flatMap(f=>[f%c,Math.floor(f/c)]);r.programs.use(this.programs("probe"),{u_texels:p}),s.drawArrays(s.TRIANGLES,
0,3)},u=r.numbers(h,t.length,o.count),m=new Float32Array(u.buffer);return(p,f)=>{let[d,g,b,y]=m.subarray(4*(p*t.length+f));
return[d,g,b,y]}}image(e,t){let r=this.graphics.context;return this.texture(e,this.key([e],t),n=>{let{data:s,shape:o}=this.
part(e),[i,c,l=1]=o,h=Math.floor(Math.log2(Math.max(c,i))),u={width:c,height:i,layers:1,channels:l,levels:h};this.fill(n,
u,()=>s);let m=p=>t[p]?r.REPEAT:r.CLAMP_TO_EDGE;r.texParameteri(r.TEXTURE_2D_ARRAY,r.TEXTURE_WRAP_S,m(1)),r.texParameteri(
r.TEXTURE_2D_ARRAY,r.TEXTURE_WRAP_T,m(0))})}fill(e,t,r){let n=this.graphics.context,{width:s,height:o,layers:i,channels:c,
levels:l}=t;et(n,e,t),n.pixelStorei(n.UNPACK_ALIGNMENT,1);let h=c===1?n.RED:n.RGBA;for(let u=0;u<i;u+=1)n.texSubImage3D(
n.TEXTURE_2D_ARRAY,0,0,0,u,s,o,1,h,n.HALF_FLOAT,r(u));l&&n.generateMipmap(n.TEXTURE_2D_ARRAY)}dropSlices(e,t){let r=t+1<
this.header.slices.steps?t+1:0,n=[e,t,r,t+1,...this.wanted];for(let s of[...this.resources.keys()])s.startsWith("slices/")&&
!n.includes(Y(s))&&this.drop(s)}bindTextures(e,t){let r=this.graphics.context,{image:n,scalars:s}=this.header,o=String(this.
scalarParts(e,t));o!==this.scalarSteps&&this.drop("scalar"),this.scalarSteps=o,this.dropSlices(e,t),this.bind("u_slices",
this.slices(e)),this.bind("u_slicesNext",t===e?null:this.slices(t)),this.bind("u_image",n&&this.image("image",[!0,!0])),
this.bind("u_stepImage",n&&this.image("step",n.repeat));let i=bn(this.parts.get("cmap")?.data??new Uint8Array(4),s);this.
bind("u_cmap",this.table("cmap",this.key(["cmap"],s.beyond),r.RGBA32F,i.length/4,()=>i));let[c,l]=this.shares(e,t);this.
bind("u_shares",s.name===null?null:this.table("scalar",c,r.RG32F,this.nodesSize[1],l));let h=()=>qn(n?.alongI??[],n?.alongJ??
[]);this.bind("u_along",n&&this.table("along","",r.RG32F,Math.max(n.alongI.length,n.alongJ.length),h))}};function Js(a,e){
a.texParameteri(e,a.TEXTURE_MIN_FILTER,a.NEAREST),a.texParameteri(e,a.TEXTURE_MAG_FILTER,a.NEAREST)}function Gi(a,e){if(a.
length===e)return a;let t=new a.constructor(e);return t.set(a),t}var Wi=60,$i=25,ji=9e8,Xi=3.5,Yi={slices:4,flow:24},It=class{layers=[];missing=[];wanted=0;pending=0;host;root;tiles=new Map;pyramid=null;chosen={
choices:new Map,steps:[],names:""};count=0;isWaiting=!1;hasAsked=!1;isOver=!1;failed=new Te;constructor(e,t){this.host=e,
this.root=t}has(e,t){return this.tiles.get(e)?.parts.has(t)??!1}fail(e,t){this.failed.add(this.need(e,t)),this.host.refine()}need(e,t){
return`${e} ${t} ${this.root.header.scalars.name}`}dispose(){this.isOver=!0;for(let e of[...this.tiles.keys()])this.drop(
e)}setPart(e,t){let{graphics:r,header:n}=this.root,s=this.tiles.get(e)??this.emptyTile();if(this.tiles.set(e,s),t.digest&&
s.parts.get(t.name)?.digest===t.digest)return;if(r.release(s.parts.get(t.name)),s.parts.set(t.name,r.hold(t)),t.name==="\
header"){let l=JSON.parse(new TextDecoder().decode(t.data));s.scene?.dispose(),l&&(l.geometry.reach=n.geometry.reach),s.
scene=l&&new _e(r,{...n,...l,pyramid:null,bodies:null,structure:null},s.parts,ce(e)),this.giveMap(s)}else s.scene?.forget(
t.name);let{names:o,steps:i}=this.chosen;this.missing=this.missing.filter(l=>!this.isHere(l,i));let c=Er(this.chosen.choices,
l=>this.isHere(l,i));String([...c.keys()])!==o&&this.host.refine()}recolour(e={}){let{steps:t}=this.chosen;for(let r of this.
tiles.values()){let{scene:n,parts:s}=r;if(!n||(Object.assign(n.header,e),this.giveMap(r),n.forget("scalars"),(t.length?n.
scalarParts(t[0],t[t.length-1]):[]).every(c=>s.has(c))))continue;let i=[...s.keys()].filter(c=>c.startsWith("scalars/"));
for(let c of i)this.release(r,c)}}emptyTile(){return{parts:new Map,scene:void 0,used:this.count}}giveMap({scene:e,parts:t}){
let r=this.root.parts.get("cmap");r&&t.set("cmap",r),e?.forget("cmap")}arrange([e,t]){let{camera:r}=this.host;if(!r)return[];
let n=this.choose(r,[...new Set([e,t])]);return this.layers=[D,...[...n.keys()].filter(s=>s!==D)].flatMap(s=>{let o=s===
D?this.root:this.tiles.get(s)?.scene,i=(n.get(s)??[]).flatMap(l=>this.pyramid?[this.pyramid.finerPart(ce(l),s)]:[]),c=s===
D?[this.root.header.pyramid?.depth??0,0,0]:ce(s);return o?[{scene:o,key:c,covered:i}]:[]}),this.layers}choose(e,t){let{header:r}=this.
root,{settings:n,canvas:s,ratio:o}=this.host;if(!r.pyramid)return new Map;this.pyramid??=new pt(r.pyramid,Dn(r)??this.root.
part("places").data);let i=this.pyramid.choose({...e.sight(s.height/o),planes:e.planes,cellPixels:Hn(r.pyramid,n),shownOn:this.
host.shownOn});this.count+=1;for(let u of i.keys()){let m=this.tiles.get(u);m&&(m.used=this.count)}let c=performance.now()+
$i,l=this.obtainable(zn(i),t,r.pyramid.depth);this.missing=l.filter(u=>!this.isHere(u,t)),this.ask(),this.trim(t);for(let u of l)
this.isHere(u,t)&&this.load(u,t,c);let h=Er(i,u=>this.isHere(u,t)&&this.load(u,t,c));return this.wanted=l.length,this.pending=
l.filter(u=>!this.isHere(u,t)||!this.isLoaded(u,t)).length,this.chosen={choices:i,steps:t,names:String([...h.keys()])},h}obtainable(e,t,r){
let n=[t,...t.map(i=>[i])],s=i=>n.some(c=>this.failed.has(this.need(i,c))),o=e.map(i=>{let[c,l,h]=ce(i);for(;c<r&&s(G([c,
l,h]));)[c,l,h]=[c+1,l>>1,h>>1];return c<r?G([c,l,h]):D});return[...new Set(o)].filter(i=>i!==D)}isHere(e,t){let r=this.
tiles.get(e)?.scene;return r===null||r?.missing(t[0],t[t.length-1]).length===0}isLoaded(e,t){let r=this.tiles.get(e)?.scene;
return r===null||(r?.isLoaded(t)??!1)}load(e,t,r){let n=this.tiles.get(e)?.scene;return!n||this.isLoaded(e,t)?!0:performance.
now()>r||!n.make(t,r)?(this.host.refine(),!1):(n.load(t),!0)}ask(){let{requests:e,lifetime:t}=this.host;this.isWaiting||
!(this.missing.length||this.hasAsked)||(this.isWaiting=!0,t.later(()=>{if(this.isWaiting=!1,this.isOver)return;this.hasAsked=
this.missing.length>0;let r=(o,i)=>this.tiles.get(o)?.scene?.lacking(i)??ie(this.root.header,i),n=this.missing.flatMap(o=>this.
chosen.steps.flatMap(i=>r(o,i))),s=[...new Set(n)].sort((o,i)=>o-i);e.wantTiles(this.missing.map(ce),s)},Wi))}trim(e){let t=0;
for(let[r,n]of[...this.tiles].sort(([,s],[,o])=>o.used-s.used)){let{parts:s,scene:o,used:i}=n,c=o?.header.slices.trace?"\
flow":"slices",l=[...s.keys()].filter(u=>u.startsWith(`${c}/`)),h=o?e.flatMap(u=>ie(o.header,u)):e;for(let u of l.slice(
0,Math.max(l.length-Yi[c],0))){let m=Y(u);if(h.includes(m))continue;for(let f of[c,"extra"])this.release(n,`${f}/${m}`);
let p=[...s.keys()].filter(f=>Ee(f,m,this.root.header));for(let f of p)this.release(n,f)}for(let{data:u}of s.values())t+=
Xi*u.byteLength;t+=o?.tracedBytes??0,t>(this.host.options.source?.memory??ji)&&i<this.count&&this.drop(r)}}drop(e){let t=this.
tiles.get(e);t?.scene?.dispose();for(let r of[...t?.parts.keys()??[]])this.release(t,r);this.tiles.delete(e)}release(e,t){
t!=="cmap"&&this.root.graphics.release(e?.parts.get(t)),e?.parts.delete(t)}};var Ct=class{scene=null;tiles=null;places=null;shown=null;view;renderer;next=[];isLate=!1;constructor(e){this.view=e,this.
renderer=new Et(e,this),!e.graphics.gl&&e.panel.fail("This browser has no WebGL2 with floating-point targets, which are \
needed to draw the picture.","Turn on hardware acceleration in its settings, or use a recent Firefox, Chrome or Safari.")}open(e){
let{view:t}=this;this.leave(),this.scene=new _e(t.graphics,e,t.parts),this.tiles=new It(t,this.scene),this.places=new Mt(
t.graphics)}leave(){this.tiles?.dispose(),this.scene?.dispose(),this.places?.dispose(),this.tiles=this.scene=this.places=
null}dispose(){this.leave(),this.renderer.dispose()}restart(e){this.renderer.restart(e)}resize(e,t){this.renderer.resize(
e,t)}refine(){this.renderer.refine()}arrange(e){let t=this.tiles?.arrange(e)??[];return this.view.root.dataset.tiles=String(
this.tiles?.pending??0),t}get smooth(){let{header:e,options:t}=this.view;return t.smooth!==void 0||!e?t.smooth??!1:this.
program(e).price<Sn}get isComing(){return!!this.tiles?.missing.length}get lacking(){let[e,t]=this.view.player.moment;return this.
scene?.missing(e,t)??[]}missing(e){return[...new Set(e.flatMap(t=>this.scene?.lacking(t)??[]))]}make(e,t){return this.next=
e,!this.missing(e).length&&!!this.scene?.make(e,t)}available(e){let{view:t,scene:r,shown:n,lacking:s}=this,{header:o,player:i}=t;
if(!o||!r)return null;let c=i.moment,l=i.playing?[1,2].map(p=>(c[1]+p)%o.slices.steps):[],h=this.missing([c[0],c[1],...this.
next,...l]);h.length&&t.requests.hasSteps&&!t.options.isComing?.()&&t.requests.wantSteps(h);let u=!s.length&&r.make(c.slice(
0,2),e);this.isLate=!u;let m=t.requests.hasMarks?r.marks.lacking(t.settings,c):[];return t.options.isComing?.()||t.requests.
wantMarks(m),t.root.dataset.lacking=String(s.length+m.length||+!u),t.panel.wait(s,u,this.renderer.leavesOut,m.length>0),
t.panel.showKinds(r.marks.legend(t.settings,c)),u&&String(c.slice(0,2))!==String(n?.slice(0,2))&&(t.trim(),t.change()),u?
this.shown=c:(s.length||t.request(),n&&r.isMade(n.slice(0,2))?n:null)}program(e,t=this.isClose(e),r=!this.view.player.playing){
let{fullVertex:n,fragment:s}=e.shaders,o=Vn(e,this.view.settings,t,r);return this.view.graphics.programs.get(n,s,...o)}isClose(e){
let{view:t}=this;if(!t.camera)return!1;let r=t.view([0,0,0],t.ratio),n=this.tiles?.layers.slice(1).map(({scene:s})=>s.header)??
[];return(n.length?n:[e]).some(s=>ht(s,t.settings,r))}frame(e,t){let{view:r,scene:n}=this,{graphics:s,header:o}=r;if(s.isLost||
!s.gl||!r.isVisible||!o||!n||r.canvas.width<2)return;this.next=[],r.advance(e);let i=this.available(t);r.camera||r.place();
let c=this.program(o);if(n.prepare(),!i||!r.camera||this.isLate&&r.sharp)return;if(c.error)return r.panel.fail("The shad\
er does not compile with this graphics driver.",c.error);if(!c.ready||!n.isReady(r.settings,this.smooth))return r.request();
let l=!r.sharp&&this.renderer.draw(c,i,t);l&&(o.slices.critical&&this.program(o,!0),r.player.varies&&this.program(o,this.
isClose(o),!1)),r.painted(l)}get canPick(){return!!this.places?.width&&!this.view.graphics.isLost}find(e,t){let{tiles:r,
shown:n,scene:s,view:o}=this,{camera:i}=o,c=r?.layers.length&&n?this.renderer.placeAt(n,e,t):null;if(!c||!i||!n||!s)return null;
let l=ws(c,s,i,n,[e,t]),h={place:[e,t],position:l.point.position,height:o.root.clientHeight};return l.point.mark=s.marks.
at(h,i,o.settings,n),l}};var Or=class{canvas=document.createElement("canvas");root=document.createElement("div");graphics=On();lifetime=new ct;held=new it(
this.graphics);parts=this.held.all;camera=null;sharp=!1;isVisible=!0;isClear=!1;shownOn=null;dispose(){this.lifetime.isOver||
(this.lifetime.end(),this.requests.stop(),this.painter.dispose?.(),this.held.clear(),this.graphics.leave(this))}get scene(){
return this.painter.scene??null}get tiles(){return this.painter.tiles??null}setPart(e){let t=pe(e.name);return t&&this.tiles?.
setPart(t[0],{...e,name:t[1]}),t||!this.held.set(e)?!1:(this.scene?.forget(e.name),this.trim(),e.name==="cmap"&&this.tiles?.
recolour(),this.change(),!0)}lack(e,t,r=[]){t!==void 0&&this.tiles?.fail(t,r),this.tell(e)}trim(){this.held.trim(this.header,
this.options.source,this.player.moment.slice(0,2))}request(){!this.lifetime.isOver&&this.isVisible&&this.graphics.request(
this)}frame(e,t){if(!this.lifetime.isOver)try{this.painter.frame(e,t)}catch(r){this.fail(r)}}lost(){this.header&&this.painter.
open?.(this.header),this.sharp=!1}view(e,t){let{header:r,camera:n,player:s,rows:o}=this;if(!r||!n)throw new Error("no sc\
ene is shown yet");return jn({header:r,camera:n,anchor:this.scene?.anchor??[0,0,0],player:s,rows:o},e,t)}find(e,t){return this.
painter.canPick?this.painter.find?.(e,t)??null:null}},Ut=class extends Or{player;isClear=!0;panel;requests;options;header;settings;painter;ratio=1;host;isNew=!0;constructor(e,{
header:t,settings:r,player:n,source:s,isComing:o}){super(),this.host=e,this.header=t,this.settings=r,this.player=n,this.
options={source:s,isComing:o},this.panel={wait:()=>{},showKinds:()=>{},fail:(i,c)=>e.failed(i,c)},this.requests=new dt(s,
this),this.graphics.users.add(this),n.setHeader(t),this.painter=new Ct(this),this.requests.setHeader(t),this.painter.open(
t)}get isHeld(){return this.host.isHeld()}chooseColours(e){let{colours:t,part:r}=yn(this.header,e,this.parts);r&&this.setPart(
r),Object.assign(this.header,t),this.painter.scene?.forget("scalars"),this.tiles?.recolour(t),this.change()}look(e,t,r,n){
let{header:s,canvas:o}=this;this.ratio=n,this.camera=new de(e,s.limits,s.geometry.planar,t/r);let i=[t,r].map(c=>Math.max(
Math.round(c*n),1));(i[0]!==o.width||i[1]!==o.height)&&this.painter.resize(i[0],i[1]),this.change(!0)}tell(e){this.host.
failed(e,"")}fail(e){this.player.playing=!1,this.host.failed("The flow cannot be drawn.",String(e))}place(){}advance(e){
let{player:t,painter:r}=this;!t.playing||!t.advance(e,n=>r.make(n,e))||(this.host.advanced(),this.change())}change(e=!1){
this.painter.restart(e),this.isNew=!0,this.refine()}refine(){this.isNew||this.painter.refine(),this.sharp=!1,this.request()}painted(e){
this.sharp=e&&!this.player.playing,(this.isNew||e)&&this.host.painted(e),this.isNew=!1,this.sharp||this.request()}get rows(){
return this.canvas.height/this.ratio}};var Zs=`// A picture of the flow on a web map; nothing beside it.

in vec3 flowtexPlaceOut;
in vec2 flowtexSidesOut;

uniform vec4 u_box;
uniform mat4 u_flowMatrix;
uniform sampler2D u_flowPicture;
uniform float u_opacity;
uniform float u_flowPixel; // share of the box's width that a pixel of the picture covers
uniform bool u_repeated;   // whether the map goes on at its other side

// Pixels beside such a side into whose colour what is clear beyond may be mixed, which keeps this share at least.
const float FLOWTEX_EDGE = 4.0;
const float FLOWTEX_LEAST_SHARE = 0.2;
const float FLOWTEX_ROUNDED = 1e-6; // share of the width by which nodes of a scene are rounded

out vec4 flowtexOut;

void main()
{
  float pixel = max(max(fwidth(flowtexSidesOut.x), fwidth(flowtexSidesOut.y)), u_flowPixel);
  vec2 inside = max(max(0.5 * pixel, FLOWTEX_ROUNDED) - flowtexSidesOut, 0.0);
  vec3 seen = flowtexPlaceOut;
  if (u_repeated)
    seen += (inside.x - inside.y) * u_box.z * u_flowMatrix[0].xyw;
  vec2 place = 0.5 + 0.5 * seen.xy / seen.z;
  if (seen.z <= 0.0 || place != clamp(place, 0.0, 1.0))
    discard;
  vec4 colour = texture(u_flowPicture, place);
  float side = min(flowtexSidesOut.x, flowtexSidesOut.y);
  if (u_repeated && side < FLOWTEX_EDGE * pixel && colour.a > FLOWTEX_LEAST_SHARE)
    colour /= colour.a;
  flowtexOut = u_opacity * colour;
}
`;var Qs=`// A piece of a web map, in the cells of a grid over a box of a tile, and where it lies in a picture of the flow\
.
// \`projectTile\` is the map's.

uniform vec4 u_box;         // its corner and its size, in the tile's own units
uniform float u_mapCells;   // cells along a side of the grid
uniform mat4 u_flowMatrix;  // from the tile to the picture's clip space

out vec3 flowtexPlaceOut;   // as x, y and w
out vec2 flowtexSidesOut;   // ways to both sides of the box, as shares of its width

void main()
{
  vec2 cell = vec2(gl_VertexID >> 1, gl_InstanceID + (gl_VertexID & 1));
  vec2 place = u_box.xy + u_box.zw * cell / u_mapCells;
  flowtexPlaceOut = (u_flowMatrix * vec4(place, 0.0, 1.0)).xyw;
  flowtexSidesOut = vec2(cell.x, u_mapCells - cell.x) / u_mapCells;
  gl_Position = projectTile(place);
}
`;var Fr=1e-5,Pe=Math.atan(Math.sinh(Math.PI))*180/Math.PI,B=Math.PI/180,Ji=88*B,ea='export it with projection="mercator"';
function ge({lng:a,lat:e}){let t=Math.sin(T(e,-Pe,Pe)*B);return[a/360+.5,.5-Math.atanh(t)/(2*Math.PI)]}var Vt=class{origin;slope;box;constructor(e,t,r){
let n=e?.map;if(!n||!t)throw new Error(`the flow is not on a map; ${ea}`);let[s,o]=r??[n[0],n[2]];this.box=[s,n[1],o,n[3]];
let[i,c]=t.shape,l=(x,v)=>{let[w,M,A]=t.data.subarray(3*(x*c+v)),S=ge({lng:Math.atan2(M,w)/B,lat:Math.asin(A/Math.hypot(
w,M,A))/B}),_=[n[0]+(n[2]-n[0])*v/(c-1),n[1]+(n[3]-n[1])*x/(i-1)];return{place:S,position:_}},[h,u,m]=[l(1,1),l(i>>1,c>>
1),l(i-2,c-2)],p=x=>x+Math.ceil(h.place[0]-x),f=[p(m.place[0])-h.place[0],m.place[1]-h.place[1]];this.slope=[0,1].map(x=>f[x]/
(m.position[x]-h.position[x])),this.origin=[0,1].map(x=>h.place[x]-this.slope[x]*h.position[x]);let[d,g]=this.placeOf(u.
position);if(!(Math.abs(d-p(u.place[0]))<Fr&&Math.abs(g-u.place[1])<Fr))throw new Error(`the flow is on another map; ${ea}`);
if(!r)return;this.slope=[1/(o-s),-1/(o-s)];let y=[p(u.place[0]),u.place[1]];this.origin=[0,1].map(x=>y[x]-this.slope[x]*
u.position[x])}placeOf(e){return[0,1].map(t=>this.origin[t]+this.slope[t]*e[t])}lngLatOf(e){let[t,r]=this.placeOf(e);return[
360*(t-.5),Math.atan(Math.sinh(2*Math.PI*(.5-r)))/B]}positionOf(e){let[t,r]=e.map((s,o)=>(s-this.origin[o])/this.slope[o]),
n=1/this.slope[0];return[t+n*Math.round((.5*(this.box[0]+this.box[2])-t)/n),r]}look(e,t){let r=1/(512*2**e.zoom*this.slope[0]),
[n,s]=this.positionOf(ge(e.center)),o=this.wholeLook(e,r,[n,s,t]);if(o)return[o];let i=d=>e.globe?this.globeLook(e,r,[d,
s,t]):this.flatLook(e,r,[d,s,t]),c=[i(n)],[l,h]=e.globe?[.5*r*c[0].width,.5*r*c[0].width]:[.5*r*Math.min(e.width,e.height),
r*Nr(e)],[u,,m]=this.box,p=n+(n<.5*(u+m)?1:-1)/this.slope[0];return!(n-l<=u&&n+l>=m)&&Math.abs(p-T(p,u,m))<h&&c.push(i(p)),
c}wholeLook(e,t,[r,n,s]){let[o,,i]=this.box;if(!(Math.abs((i-o)*this.slope[0]-1)<Fr)||e.globe||e.pitch>0)return null;let l=t*
Nr(e);if(r-l>o||r+l<i)return null;let{height:h}=e;e.bearing&&(h=2*l/t);let u=(i-o)/t;return this.flatLook({...e,width:u,
height:h,bearing:0},t,[.5*(o+i),n,s])}flatLook({width:e,height:t,bearing:r,pitch:n,fov:s},o,[i,c,l]){let[h,u]=[r*B,n*B],
m=.5*t*o,p=m/Math.tan(.5*s*B);return{state:{position:[i-p*Math.sin(u)*Math.sin(h),c-p*Math.sin(u)*Math.cos(h),l+p*Math.cos(
u)],focal_point:[i,c,l],up:[Math.sin(h),Math.cos(h),0],parallel:n===0,parallel_scale:m,view_angle:s},width:e,height:t}}globeLook(e,t,[
r,,n]){let s=1/(t*this.slope[0]),o=T(e.center.lat,-Pe,Pe)*B,i=s/(2*Math.PI*Math.cos(o)),c=Math.asin(Math.min(Nr(e)/i,1)),
[l,h]=[o-c,o+c].map(b=>ge({lng:0,lat:b/B})[1]),u=Math.abs(o)+c<=Math.PI/2?Math.asin(Math.sin(c)/Math.cos(o)):Math.PI,m=(.5*
(l+h)-this.origin[1])/this.slope[1],[p,f]=[u/Math.PI,l-h],d={position:[r,m,n+1/this.slope[0]],focal_point:[r,m,n],up:[0,
1,0],parallel:!0,parallel_scale:.5*f/this.slope[0],view_angle:e.fov},g=new Ir(this,e.center,c);return{state:d,width:p*s,
height:f*s,shownOn:g}}},Ir=class{mercator;middle;cosine;seen;constructor(e,{lng:t,lat:r},n){let s=T(r,-Pe,Pe);this.mercator=
e,this.middle=ta(t,s),this.cosine=Math.cos(s*B),this.seen=n}sees(e){let[t,r,,n]=Array.from(e);return Math.acos(T(P(ta(...this.
mercator.lngLatOf([t,r])),this.middle),-1,1))<=this.seen+this.angle(n)}scale(e){let[,t,,r]=Array.from(e),n=Math.abs(2*Math.
PI*(this.mercator.placeOf([0,t])[1]-.5)),s=Math.max(n-this.angle(r),0);return Math.min(1/Math.cosh(s)/this.cosine,1)}angle(e){
return 2*Math.PI*this.mercator.slope[0]*e}};function ta(a,e){let t=Math.cos(e*B);return[t*Math.cos(a*B),t*Math.sin(a*B),
Math.sin(e*B)]}function Nr({width:a,height:e,pitch:t,fov:r}){let[n,s]=[t*B,.5*r*B],o=n+s;if(o>Ji)return 1/0;let c=.5*e/Math.
tan(s)*Math.cos(n)*(Math.tan(o)-Math.tan(n));return Math.hypot(c,.5*a*Math.cos(n)*Math.cos(s)/Math.cos(o))}var Cr=8192,Zi=22,Qi=512,ec=64,Dt=class{view;isUsed=!1;texture;shown=null;next=null;constructor(e,t){this.view=t,this.texture=
e.createTexture()}dispose(e){this.view.dispose(),e?.deleteTexture(this.texture)}follow(e,t){this.isUsed=this.view.isVisible=
e!==void 0,this.view.shownOn=e?.shownOn??null,e?this.view.look(e.state,e.width,e.height,t):this.shown=this.next=null}painted(e){
let{camera:t}=this.view;t&&this.isUsed&&(this.next={camera:t,isComplete:e})}get isComplete(){let{view:e,next:t,shown:r}=this;
return!this.isUsed||e.sharp&&!t&&!!r?.isComplete&&!e.tiles?.pending}upload(e,t){if(this.next){e.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,
!0),e.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!0),e.texImage2D(e.TEXTURE_2D,0,e.RGBA,e.RGBA,e.UNSIGNED_BYTE,this.view.
canvas);for(let r of[e.TEXTURE_WRAP_S,e.TEXTURE_WRAP_T])e.texParameteri(e.TEXTURE_2D,r,e.CLAMP_TO_EDGE);t&&e.generateMipmap(
e.TEXTURE_2D),e.texParameteri(e.TEXTURE_2D,e.TEXTURE_MIN_FILTER,t?e.LINEAR_MIPMAP_LINEAR:e.LINEAR),e.texParameteri(e.TEXTURE_2D,
e.TEXTURE_MAG_FILTER,e.LINEAR),this.shown=this.next,this.next=null}}draw(e){let{gl:t,programs:r,mercator:n,globe:s}=e,{vertexShaderPrelude:o,
define:i}=e.shaderData,c=r.get(`${i}
${o}
${Qs}`,Zs);if(!c.ready)return c.error;if(t.activeTexture(t.TEXTURE0),t.bindTexture(t.TEXTURE_2D,this.texture),this.upload(
t,s),!this.shown)return!0;let{camera:l}=this.shown,h=Math.floor(T(e.zoom,0,Zi)),u=n.placeOf(l.state.focal_point),m=2**h,
p=[Math.floor(u[0]*m),T(Math.floor(u[1]*m),0,m-1)],f=Math.floor(p[0]/m),d={z:h,x:p[0]-f*m,y:p[1]},g=L=>L.map((C,I)=>(C*m-
p[I])*Cr),[b,y,x,v]=n.box,[w,M]=[[b,y],[x,v]].map(L=>g(n.placeOf(L)));t.bindVertexArray(e.array);let A=s?ec:1,S=s?0:Math.
round(ge(e.center)[0]-u[0]),_=0;e.isRepeated&&!s&&(_=Math.ceil(t.drawingBufferWidth/(Qi*2**e.zoom)));for(let L=-_;L<=_;L+=
1){let C={wrap:f+S+L,canonical:d},I=e.getProjectionData({tileID:C,applyGlobeMatrix:s});r.use(c,{u_projection_matrix:I.mainMatrix,
u_projection_fallback_matrix:I.fallbackMatrix,u_projection_tile_mercator_coords:I.tileMercatorCoords,u_projection_clipping_plane:I.
clippingPlane,u_projection_transition:I.projectionTransition,u_box:[...w,M[0]-w[0],M[1]-w[1]],u_mapCells:A,u_flowMatrix:tc(
this.view.header,l,n,p,1/(m*Cr)),u_flowPicture:0,u_flowPixel:2*l.height/this.view.canvas.height/(x-b),u_repeated:!!this.
view.header.ends,u_opacity:e.opacity}),t.drawArraysInstanced(t.TRIANGLE_STRIP,0,2*A+2,A)}return t.bindVertexArray(null),
!0}};function tc({geometry:a},e,t,r,n){let{center:s,frame:o}=a,{focal_point:i}=e.state,c=O(o,E(i,s)),l=z(a,e,c),h=[0,1].
map(f=>O(o,[0,1].map(d=>d===f?n/t.slope[f]:0).concat(0))),u=t.placeOf(i),m=[0,1].map(f=>(r[f]*n*Cr-u[f])/t.slope[f]).concat(
0);return[...h,[0,0,0],O(o,m)].flatMap((f,d)=>[0,1,2,3].map(g=>f.reduce((b,y,x)=>b+l[4*x+g]*y,d===3?l[12+g]:0)))}var Bt=class{atOnce=1;header;parts=[];tiles=new Map;known;texts;constructor(e,t,r,n){this.header=e,this.known=r,this.texts=
n;for(let s of t){let[{name:o,digest:i},c]=s,l=pe(o)?.[0];l?this.tiles.set(l,[...this.tiles.get(l)??[],s]):this.parts.push(
s),l&&c&&n.set(i,c)}}load=(e,t)=>{let r=((e&&this.tiles.get(G(e)))??[]).filter(([{name:n}])=>{let s=pe(n)?.[1]??"",o=Y(s),
i=s.startsWith("scalars/")&&!Ee(s,o,this.header);return Number.isNaN(o)||t.includes(o)||i});return Promise.all(r.map(n=>this.
unpacked(n)))};async unpacked([e,t]){let{digest:r,name:n}=e,s=this.known.get(r);return s?{...s,name:n}:tn(e,t||(this.texts.
get(r)??""))}async kept(e){let t=await this.unpacked(e);return this.known.set(t.digest,t),t}};var Be=class{};var be=class extends Error{},q=class extends be{_tag="NotFoundError";name="NotFoundError";path;found;constructor(e,t={}){
super(`Not found: ${e}`,{cause:t.cause}),this.path=t.path,this.found=t.found}},H=class extends be{_tag="InvalidMetadataE\
rror";name="InvalidMetadataError";path;constructor(e,t={}){super(e,{cause:t.cause}),this.path=t.path}},He=class extends be{_tag="\
UnknownCodecError";name="UnknownCodecError";codec;constructor(e){super(`Unknown codec: ${e}`),this.codec=e}},ze=class extends be{_tag="\
CodecPipelineError";name="CodecPipelineError";direction;codec;chunkPath;constructor(e){let t=[`Failed to ${e.direction} \
chunk`,e.codec&&`via codec "${e.codec}"`,e.chunkPath&&`at ${e.chunkPath}`].filter(Boolean);super(t.join(" "),{cause:e.cause}),
this.direction=e.direction,this.codec=e.codec,this.chunkPath=e.chunkPath}};var ye=class extends be{_tag="UnsupportedError";name="UnsupportedError";feature;constructor(e){super(`Unsupported: ${e}`),
this.feature=e}};var Ge=class{},We=class{},$e=class{};function na(){if(typeof SharedArrayBuffer>"u")throw new Error("SharedArrayBuffer is not available. In browsers, this req\
uires Cross-Origin-Opener-Policy and Cross-Origin-Embedder-Policy headers to be set.")}function sa(a,e){return e?new SharedArrayBuffer(
a):new ArrayBuffer(a)}function je(a){let e=new TextDecoder().decode(a);try{return JSON.parse(e)}catch(t){throw new H("Fa\
iled to decode JSON",{cause:t})}}function Ur(a,e){let t=e/2,r=e-1,n=0;for(let s=0;s<a.length;s+=e)for(let o=0;o<t;o+=1)n=
a[s+o],a[s+o]=a[s+r-o],a[s+r-o]=n}function zt(a){if(a==="v2:object")return globalThis.Array;let e=a.match(/v2:([US])(\d+)/);
if(e){let[,r,n]=e;return(r==="U"?$e:We).bind(null,Number(n))}if(a==="string")return globalThis.Array;let t={int8:Int8Array,
int16:Int16Array,int32:Int32Array,int64:globalThis.BigInt64Array,uint8:Uint8Array,uint16:Uint16Array,uint32:Uint32Array,
uint64:globalThis.BigUint64Array,float16:globalThis.Float16Array,float32:Float32Array,float64:Float64Array,bool:Ge}[a];if(!t)
throw new H(`Unknown or unsupported dataType: ${a}`);return t}function Gt(a,e){let t=a.length;typeof e=="string"&&(e=e===
"C"?Array.from({length:t},(s,o)=>o):Array.from({length:t},(s,o)=>t-1-o)),la(t===e.length,"Order length must match the nu\
mber of dimensions.");let r=1,n=new Array(t);for(let s=e.length-1;s>=0;s--)n[e[s]]=r,r*=a[e[s]];return n}function aa({name:a,
configuration:e}){if(a==="default"){let t=e?.separator??"/";return r=>["c",...r].join(t)}if(a==="v2"){let t=e?.separator??
".";return r=>r.join(t)||"0"}throw new H(`Unknown chunk key encoding: ${a}`)}function ra(a){if(a==="|O")return{dataType:"\
v2:object"};let e=a.match(/^([<|>])(.*)$/);if(!e)throw new H(`Invalid dtype: ${a}`);let[,t,r]=e,n={b1:"bool",i1:"int8",u1:"\
uint8",i2:"int16",u2:"uint16",i4:"int32",u4:"uint32",i8:"int64",u8:"uint64",f2:"float16",f4:"float32",f8:"float64"}[r]??
(r.startsWith("S")||r.startsWith("U")?`v2:${r}`:void 0);if(!n)throw new H(`Unsupported or unknown dtype: ${a}`);return t===
"|"?{dataType:n}:{dataType:n,endian:t==="<"?"little":"big"}}function rc(a){return(a.id==="fixedscaleoffset"||a.id==="num\
codecs.fixedscaleoffset")&&typeof a.scale=="number"&&typeof a.offset=="number"&&(a.astype===void 0||typeof a.astype=="st\
ring")&&(a.dtype===void 0||typeof a.dtype=="string")}function oa(a,e={}){let t=[],r=ra(a.dtype);a.order==="F"&&t.push({name:"\
transpose",configuration:{order:"F"}});for(let s of a.filters??[]){if(s.id==="fixedscaleoffset"||s.id==="numcodecs.fixed\
scaleoffset"){if(!rc(s))throw new H(`Invalid fixedscaleoffset filter: ${JSON.stringify(s)}`);t.push({name:"scale_offset",
configuration:{scale:s.scale,offset:s.offset}});let c=s.astype??s.dtype;if(c!==void 0&&c!==a.dtype){let l=ra(c).dataType;
if(!Ht(l,"number")&&!Ht(l,"bigint"))throw new H(`fixedscaleoffset astype must be a numeric data type, got ${c}`);t.push(
{name:"cast_value",configuration:{data_type:l,rounding:"nearest-even",out_of_range:"wrap"}})}continue}let{id:o,...i}=s;t.
push({name:`numcodecs.${o}`,configuration:i})}if("endian"in r&&r.endian==="big"&&t.push({name:"bytes",configuration:{endian:"\
big"}}),a.compressor){let{id:s,...o}=a.compressor;t.push({name:`numcodecs.${s}`,configuration:o})}let n;return globalThis.
Array.isArray(e._ARRAY_DIMENSIONS)&&(n=e._ARRAY_DIMENSIONS),{zarr_format:3,node_type:"array",shape:a.shape,data_type:r.dataType,
chunk_grid:{name:"regular",configuration:{chunk_shape:a.chunks}},chunk_key_encoding:{name:"v2",configuration:{separator:a.
dimension_separator??"."}},codecs:t,fill_value:a.fill_value,dimension_names:n,attributes:e}}function ia(a,e={}){return{zarr_format:3,
node_type:"group",attributes:e}}function Ht(a,e){if(e!=="number"&&e!=="bigint"&&e!=="boolean"&&e!=="object"&&e!=="string")
return a===e;let t=a==="bool";if(e==="boolean")return t;let r=a.startsWith("v2:U")||a.startsWith("v2:S")||a==="string";if(e===
"string")return r;let n=a==="int64"||a==="uint64";if(e==="bigint")return n;let s=a==="v2:object";return e==="object"?s:!r&&
!n&&!t&&!s}function ca(a){return a?.name==="sharding_indexed"}function Wt(a){if((a.data_type==="uint64"||a.data_type==="\
int64")&&a.fill_value!=null)return BigInt(a.fill_value);let e=a.data_type==="float16"||a.data_type==="float32"||a.data_type===
"float64";if(typeof a.fill_value=="string"&&e){let t={NaN:NaN,Infinity:1/0,"-Infinity":-1/0};if(a.fill_value in t)return t[a.
fill_value]}return a.fill_value}function Vr(a,...e){if(!e.some(t=>a instanceof t))throw a}function la(a,e=""){if(!a)throw new Error(e)}async function ha(a,{
format:e,signal:t}){let r;if(a instanceof ArrayBuffer)r=new Response(a);else{let n=new Uint8Array(a.buffer,a.byteOffset,
a.byteLength);r=new Response(n.slice().buffer)}la(r.body,"Response does not contain body.");try{return await new Response(
r.body.pipeThrough(new DecompressionStream(e),{signal:t})).arrayBuffer()}catch{throw t?.throwIfAborted(),new Error(`Fail\
ed to decode ${e}`)}}var ua=nc();function nc(){let a=new Uint32Array([305419896]);return new Uint8Array(a.buffer,a.byteOffset,a.byteLength)[0]!==
18}function ma(a){return"BYTES_PER_ELEMENT"in a?a.BYTES_PER_ELEMENT:4}var Xe=class a{kind="array_to_bytes";#e;#t;#r;#s;#n;constructor(e,t){
this.#n=e?.endian,this.#t=zt(t.dataType),this.#s=t.shape,this.#e=Gt(t.shape,"C");let r=new this.#t(0);this.#r=r.BYTES_PER_ELEMENT}static fromConfig(e,t){
return new a(e,t)}encode(e){let t=new Uint8Array(e.data.buffer);return ua&&this.#n==="big"&&(t=t.slice(),Ur(t,ma(this.#t))),
t}computeEncodedSize(e){return e}decode(e){return ua&&this.#n==="big"&&(e=e.slice(),Ur(e,ma(this.#t))),e.byteOffset%this.#r!==
0&&(e=e.slice()),{data:new this.#t(e.buffer,e.byteOffset,e.byteLength/this.#r),shape:this.#s,stride:this.#e}}};var $t=class{};function jt(a){return()=>{throw new ye(`${a} encode`)}}var Xt=class a{kind="bytes_to_bytes";static fromConfig(){return new a}encode=jt("crc32c");decode(e){return new Uint8Array(
e.buffer,e.byteOffset,e.byteLength-4)}computeEncodedSize(e){return e+4}};var Yt=class{};var qt=class a{kind="bytes_to_bytes";static fromConfig(e){return new a}encode=jt("gzip");async decode(e){let t=await ha(
e,{format:"gzip"});return new Uint8Array(t)}};var Ye=class{};var Kt=class{};var Jt=class{};var Zt=class{};var qe=class{};var Qt=class{};function sc(){let a=()=>import("numcodecs/blosc").then(s=>s.default),e=()=>import("numcodecs/lz4").then(s=>s.default),t=()=>import("numcodecs/zstd").
then(s=>s.default),r=()=>qt,n=()=>Qt;return new Map().set("blosc",a).set("lz4",e).set("zstd",t).set("gzip",r).set("zlib",
n).set("transpose",()=>Zt).set("bytes",()=>Xe).set("crc32c",()=>Xt).set("vlen-utf8",()=>qe).set("json2",()=>Ye).set("bit\
round",()=>Be).set("cast_value",()=>$t).set("scale_offset",()=>Kt).set("numcodecs.blosc",a).set("numcodecs.lz4",e).set("\
numcodecs.zstd",t).set("numcodecs.gzip",r).set("numcodecs.zlib",n).set("numcodecs.vlen-utf8",()=>qe).set("numcodecs.shuf\
fle",()=>Jt).set("numcodecs.delta",()=>Yt).set("numcodecs.bitround",()=>Be).set("numcodecs.json2",()=>Ye)}var Ke=sc();function Je(a){
let e;function t(){return e||(e=ac(a)),e}async function r(n,s,o){try{return await o()}catch(i){throw new ze({direction:n,
codec:s,cause:i})}}return{async encode(n){let s=await t();for(let{name:i,codec:c}of s.arrayToArray)n=await r("encode",i,
()=>c.encode(n));let o=await r("encode",s.arrayToBytes.name,()=>s.arrayToBytes.codec.encode(n));for(let{name:i,codec:c}of s.
bytesToBytes)o=await r("encode",i,()=>c.encode(o));return o},async decode(n){let s=await t();for(let i=s.bytesToBytes.length-
1;i>=0;i--){let{name:c,codec:l}=s.bytesToBytes[i];n=await r("decode",c,()=>l.decode(n))}let o=await r("decode",s.arrayToBytes.
name,()=>s.arrayToBytes.codec.decode(n));for(let i=s.arrayToArray.length-1;i>=0;i--){let{name:c,codec:l}=s.arrayToArray[i];
o=await r("decode",c,()=>l.decode(o))}return o},async computeEncodedSize(n){let s=await t(),o=pa(s.arrayToBytes.name,s.arrayToBytes.
codec,n);for(let{name:i,codec:c}of s.bytesToBytes)o=pa(i,c,o);return o}}}function pa(a,e,t){if(!e.computeEncodedSize)throw new H(
`Codec "${a}" cannot compute its encoded size; it is not a fixed-size codec and cannot be used in a sharding index pipel\
ine`);return e.computeEncodedSize(t)}async function ac(a){let e=a.codecs.map(async o=>{let i=await Ke.get(o.name)?.();if(!i)
throw new He(o.name);return{Codec:i,meta:o}}),t=[],r,n=[],s={...a};for await(let{Codec:o,meta:i}of e){let c=o.fromConfig(
i.configuration,s);switch(c.kind){case"array_to_array":t.push({name:i.name,codec:c}),c.getEncodedMeta&&(s=c.getEncodedMeta(
s));break;case"array_to_bytes":r={name:i.name,codec:c};break;default:n.push({name:i.name,codec:c})}}if(!r){if(!oc(s))throw new H(
`Cannot encode ${s.dataType} to bytes without a codec`);r={name:"bytes",codec:Xe.fromConfig({endian:"little"},s)}}return{
arrayToArray:t,arrayToBytes:r,bytesToBytes:n}}function oc(a){return a.dataType!=="v2:object"&&a.dataType!=="string"}var fa=18446744073709551615n;function da(a,e,t,r){if(!a.store.getRange)throw new ye("sharding requires a store with getR\
ange");let n=a.store.getRange.bind(a.store),s=e.map((l,h)=>l/r.chunk_shape[h]),o=Je({dataType:"uint64",shape:[...s,2],codecs:r.
index_codecs,fillValue:null}),i=16*s.reduce((l,h)=>l*h,1),c={};return async(l,h)=>{let u=l.map((v,w)=>Math.floor(v/s[w])),
m=a.resolve(t(u)).path;m in c||(c[m]=(async()=>{let v=await o.computeEncodedSize(i),w=await n(m,{suffixLength:v},h);return w?
await o.decode(w):null})().catch(v=>{throw delete c[m],v}));let p=await c[m];if(p===null)return;let{data:f,shape:d,stride:g}=p,
b=l.map((v,w)=>v%d[w]).reduce((v,w,M)=>v+w*g[M],0),y=f[b],x=f[b+1];if(!(y===fa&&x===fa))return n(m,{offset:Number(y),length:Number(
x)},h)}}var se=class a{store;path;constructor(e,t="/"){this.store=e,this.path=t}resolve(e){let t=new URL(`file://${this.path.endsWith(
"/")?this.path:`${this.path}/`}`);return new a(this.store,decodeURIComponent(new URL(e,t).pathname))}};function tr(a){return new se(
a??new Map)}var xe=class extends se{kind="group";#e;constructor(e,t,r){super(e,t),this.#e=r}get attrs(){return this.#e.attributes}};
function ga(a){return a.find(t=>t.name==="transpose")?.configuration?.order??"C"}function ic(a,e){let t=new Map(e.map((r,n)=>[
r,n]));return a.filter(r=>t.has(r)).map(r=>t.get(r))}function ba(a){return(e,t)=>{let r=globalThis.Array.isArray(a)&&t?ic(
a,t):a;return Gt(e,r)}}var er=Symbol("zarrita.context");function cc(a,e){let{configuration:t}=e.codecs.find(ca)??{},r={encodeChunkKey:aa(e.chunk_key_encoding),TypedArray:zt(e.data_type),
fillValue:e.fill_value};if(t){let s=ga(t.codecs);return{...r,kind:"sharded",chunkShape:t.chunk_shape,codec:Je({dataType:e.
data_type,shape:t.chunk_shape,codecs:t.codecs,fillValue:e.fill_value}),getStrides:ba(s),getChunkBytes:da(a,e.chunk_grid.
configuration.chunk_shape,r.encodeChunkKey,t)}}let n=ga(e.codecs);return{...r,kind:"regular",chunkShape:e.chunk_grid.configuration.
chunk_shape,codec:Je({dataType:e.data_type,shape:e.chunk_grid.configuration.chunk_shape,codecs:e.codecs,fillValue:e.fill_value}),
getStrides:ba(n),async getChunkBytes(s,o){let i=r.encodeChunkKey(s),c=a.resolve(i).path;return a.store.get(c,o)}}}var he=class extends se{kind="\
array";#e;[er];constructor(e,t,r){super(e,t),this.#e={...r,fill_value:Wt(r)},this[er]=cc(this,this.#e)}get attrs(){return this.#e.
attributes}get dimensionNames(){return this.#e.dimension_names}get fillValue(){return this.#e.fill_value}get shape(){return this.#e.
shape}get chunks(){return this[er].chunkShape}get dtype(){return this.#e.data_type}async getChunk(e,t,r){r?.useSharedArrayBuffer&&
na();let n=this[er],s=await n.getChunkBytes(e,t);if(!s){let o=n.chunkShape.reduce((c,l)=>c*l,1),i;if(r?.useSharedArrayBuffer){
let c=new n.TypedArray(0);if(!("BYTES_PER_ELEMENT"in c))console.warn("zarrita: useSharedArrayBuffer is not supported for\
 non-buffer-backed data types."),i=new n.TypedArray(o);else{let l=sa(o*c.BYTES_PER_ELEMENT,!0);i=new n.TypedArray(l,0,o)}}else
i=new n.TypedArray(o);return i.fill(n.fillValue),{data:i,shape:n.chunkShape,stride:n.getStrides(n.chunkShape)}}return n.
codec.decode(s)}is(e){return Ht(this.dtype,e)}};function ya(a,e){let t=a;for(let r of e)t instanceof Promise?t=t.then(n=>r(n)):t=r(t);return t}function xa(a,...e){return ya(a,e)}async function Ma(a){let e=a.store.arrayExtensions;return e?.length?await xa(a,...e):a}var rr=lc();function lc(){let a=new WeakMap;
function e(t){let r=a.get(t)??{v2:0,v3:0};return a.set(t,r),r}return{increment(t,r){e(t)[r]+=1},versionMax(t){let r=e(t);
return r.v3>r.v2?"v3":"v2"}}}async function hc(a,e){let t=await a.store.get(a.resolve(".zattrs").path,{signal:e});return t?
je(t):{}}async function uc(a,e={}){let t="store"in a?a:new se(a),{signal:r}=e,n={};return(e.attrs??!0)&&(n=await hc(t,r)),
r?.throwIfAborted(),e.kind==="array"?va(t,n,r):e.kind==="group"?wa(t,n,r):va(t,n,r).catch(s=>(Vr(s,q,H),wa(t,n,r)))}async function va(a,e,t){
let{path:r}=a.resolve(".zarray"),n=await a.store.get(r,{signal:t});if(!n)throw new q("v2 array",{path:r});return rr.increment(
a.store,"v2"),Ma(new he(a.store,a.path,oa(je(n),e)))}async function wa(a,e,t){let{path:r}=a.resolve(".zgroup"),n=await a.
store.get(r,{signal:t});if(!n)throw new q("v2 group",{path:r});return rr.increment(a.store,"v2"),new xe(a.store,a.path,ia(
je(n),e))}async function mc(a,e){let{store:t,path:r}=a.resolve("zarr.json"),n=await a.store.get(r,{signal:e});if(!n)throw new q(
"v3 array or group",{path:r});let s=je(n);return s.node_type==="array"&&(s.fill_value=Wt(s)),s.node_type==="array"?Ma(new he(
t,a.path,s)):new xe(t,a.path,s)}async function pc(a,e={}){let t="store"in a?a:new se(a),r=await mc(t,e.signal);if(rr.increment(
t.store,"v3"),e.kind===void 0||e.kind==="array"&&r instanceof he||e.kind==="group"&&r instanceof xe)return r;let n=r instanceof
he?"array":"group";throw new q(`${e.kind} at ${t.path}`,{path:t.path,found:n})}async function ee(a,e={}){let t="store"in
a?a.store:a,r=rr.versionMax(t),n=r==="v2"?ee.v2:ee.v3,s=r==="v2"?ee.v3:ee.v2;return n(a,e).catch(o=>(Vr(o,q,H),s(a,e)))}
ee.v2=uc;ee.v3=pc;var Ea=[300,1e3,3e3],Sa=2e4,dc=[401,403,404,410],Aa=200,gc=429,bc=500,yc=2197175160,Dr=4,xc=8,vc=1<<28,$=class extends Error{fault;detail;constructor(e,t,r=t){
super(t),this.fault=e,this.detail=r}},wc=Array.from({length:4},(a,e)=>Uint32Array.from({length:256},(t,r)=>{let n=r;for(let s=0;s<
8*(e+1);s+=1)n=n>>>1^(n&1?yc:0);return n}));function Mc(a){let[e,t,r,n]=wc,s=a.length-a.length%4,o=4294967295;for(let i=0;i<
s;i+=4)o^=a[i]|a[i+1]<<8|a[i+2]<<16|a[i+3]<<24,o=n[o&255]^r[o>>>8&255]^t[o>>>16&255]^e[o>>>24];for(let i=s;i<a.length;i+=
1)o=o>>>8^e[(o^a[i])&255];return~o>>>0}async function _a(a,e){let t=[],r=0,n=a?.getReader();try{for(;;){let{done:o=!0,value:i}=await n?.
read()??{};if(o||!i)break;t.push(i),r+=i.length,e(r)}}catch(o){throw n?.cancel().catch(()=>{}),o}let s=new Uint8Array(r);
return t.reduce((o,i)=>(s.set(i,o),o+i.length),0),s}var Br=class a{kind="bytes_to_bytes";static fromConfig(){return new a}encode(){
throw new Error("nothing is written")}decode(e){let t=e.byteLength-Dr;if(t<0)throw new Error("the checksum is missing");
let{buffer:r,byteOffset:n}=e,s=new DataView(r,n+t,Dr).getUint32(0,!0),o=new Uint8Array(r,n,t);if(s!==Mc(o))throw new Error(
"checksum mismatch");return o}computeEncodedSize(e){return e+Dr}},Hr=class a{kind="bytes_to_bytes";most;constructor(e){this.
most=e}static fromConfig(e,{shape:t}){return new a(Math.min(t.reduce((r,n)=>r*n,xc),vc))}encode(){throw new Error("nothi\
ng is written")}async decode(e){let t=new Blob([e]).stream();return _a(t.pipeThrough(new DecompressionStream("gzip")),r=>{
if(r>this.most)throw new Error(`a chunk unpacks to more than ${this.most} bytes`)})}};Ke.set("gzip",()=>Promise.resolve(
Hr));Ke.set("crc32c",()=>Promise.resolve(Br));function Ec(a,e){return new Promise((t,r)=>{let n=()=>{clearTimeout(s),r(e.
reason)},s=setTimeout(()=>{e.removeEventListener("abort",n),t()},a);e.addEventListener("abort",n,{once:!0})})}async function Sc(a,e){
let t=new AbortController,r=()=>t.abort();e.addEventListener("abort",r,{once:!0});let n=setTimeout(r,Sa);try{e.throwIfAborted();
let{status:s,body:o}=await fetch(a,{signal:t.signal}),i=await _a(s===Aa?o:null,()=>{clearTimeout(n),n=setTimeout(r,Sa)});
return[s,i]}finally{t.abort(),clearTimeout(n),e.removeEventListener("abort",r)}}async function Ta(a,e){for(let t=0;;t+=1){
let r="no server answers";try{let[n,s]=await Sc(a,e);if(n===Aa)return s;if(dc.includes(n))return;if(r=`the server answer\
s ${n}`,n<bc&&n!==gc)throw new $("broken",r)}catch(n){if(e.throwIfAborted(),n instanceof $)throw n}if(t===Ea.length)throw new $(
"unreachable",r);await Ec(Ea[t],e)}}var nr=class{url;described;shards=new Map;constructor(e,t){this.url=e,this.described=
t}get=async(e,t)=>e.endsWith("/zarr.json")?this.description(e):this.object(e,t?.signal);getRange=async(e,t,r)=>{let n=this.
shards.get(e)??this.object(e,r?.signal);this.shards.set(e,n);let s=await n;return"suffixLength"in t?s?.subarray(-t.suffixLength):
s?.subarray(t.offset,t.offset+t.length)};async object(e,t=new AbortController().signal){let r=await Ta(this.url+e,t);if(!r)
throw new $("missing",`${e} is missing`);return r}description(e){let t=this.described.get(e);if(t)return t;let r=Ta(this.
url+e,new AbortController().signal);return this.described.set(e,r),r.catch(()=>this.described.delete(e)),r}};function Pa(a){
if(a instanceof $)return a;let e=a instanceof q&&!a.found?"missing":"broken";return new $(e,a instanceof Error?a.message:
String(a))}var sr=class{url;described=new Map;constructor(e){this.url=e.replace(/\/+$/,"")}async attributes(){let e=new nr(
this.url,this.described);return(await ee.v3(tr(e),{kind:"group"})).attrs}async array(e){let t=new nr(this.url,this.described),
r=await ee.v3(tr(t).resolve(e),{kind:"array"});if(!r.is("number"))throw new $("broken",`${e} has no numbers`);return r}};var Tc=64,Ac=32,ar=4096,_c=2**28,Pc=["padded","unit","open","nearest","normal","rays"],Rc={missing:"it is not in the sto\
re, or the store is not public.",broken:"its data in the store are corrupt.",unreachable:"the store does not answer. The\
 server or the network may be down, or the server does not allow this page to read it (CORS)."},Lc=["format","fingerprin\
t","parameter","lines"],ve=(a,e)=>Number.isInteger(a)&&Number(a)>0&&Number(a)<=e,j=(a,e)=>Array.isArray(a)&&a.every(Number.
isFinite)&&(e??a.length)===a.length,kc=(a,e)=>j(a,e)&&a.every(Number.isInteger);function Oc({nodes:a,longest:e=0,poles:t=[]}){
return Number.isFinite(e)&&t.length<=2&&t.every(({component:r,line:n,inward:s,near:o,plane:i})=>[0,1].includes(r)&&r===t[0].
component&&n===(s>0?0:a[1-r]-1)&&[1,-1].includes(s)&&ve(o,ar)&&j(i,6))}function Fc(a,{geometry:e,slices:t}){let{geometry:r,
slices:n}=a,{shape:s,rows:o,columns:i}=r,{trace:c}=n;if(!(j(s,2)&&s.every(h=>ve(h,ar)&&h>1)&&[o,i].every(({before:h,size:u},m)=>Number.
isInteger(h)&&ve(u,ar)&&h>=0&&h+s[m]<=u)&&Number.isInteger(r.levels)&&r.levels>=0&&2**r.levels<=Math.max(o.size,i.size)&&
r.triangles===e.triangles&&r.planar===e.planar&&Number.isFinite(r.extent)&&j(r.periodic.map(Number),2)&&j(r.center,3)&&j(
r.frame,9)&&ve(n.count,Tc)&&[2,4].includes(n.channels)&&j(n.lags)&&ve(n.lags.length,Ac)&&n.sides===t.sides&&j(n.extra)&&
n.extra.every(h=>Number.isInteger(h)&&h>=0&&h<n.count)&&j([n.unit,n.cell,n.critical])&&(!c||c.parts.every(h=>Pc.includes(
h))&&j(c.nodes,2)&&c.nodes.every((h,u)=>ve(h,ar)&&c.drawn[u]+s[u]<=h)&&kc([...c.first,...c.drawn],4)&&c.drawn.every(h=>h>=
0)&&j(c.closed.map(Number),2)&&j([...c.offset,...c.middle,c.unit,c.pace,c.rest],12)&&Oc(c)&&(!c.timed||j([c.timed.unit,c.
timed.speed],2)))))throw new Error("the header of a tile does not match the page")}function La({geometry:a,slices:e}){let{
shape:t,planar:r}=a,{trace:n,count:s,channels:o,extra:i}=e,c=(p,...f)=>[...p,...f].reduce((d,g)=>d*g,1),l=[a.rows.size,a.
columns.size],h=n?.nodes??[],u={cells:[Uint8Array,[c(t.map(p=>p-1))]],normal:[Int16Array,[c(t,3)]],scalars:[Float32Array,
[c(t)]]};if(n){u.unit=[Uint16Array,[c(h)]],u.padded=[Float32Array,[c(h.map(f=>f+2),3)]],u.open=[Uint8Array,[c(h)]],u.nearest=
[Int16Array,[c(h,2)]];let p=n.poles??[];u.rays=[Float32Array,[c(p.slice(0,1).map(f=>h[f.component]),2,p.length)]],u.flow=
[Uint16Array,n.uncertain?[c(h,5)]:[c(h,3),c(h,4)]]}else u.position=[Float32Array,[c(t,3)]],u.slices=[Uint16Array,[c(l,s,
o)]],u.extra=[Uint16Array,[c(l,i.length)]];let m=n?["mesh",...n.parts]:["mesh","position",...r?[]:["normal"]];return{sizes:u,
needed:m}}function zr(a,e,t){let{sizes:r}=La(e),n=e.geometry.shape.map(s=>Math.ceil((s-1)/t));for(let{name:s,data:o,shape:i}of a){
let c=r[s.split("/")[0]];if(!(c?o instanceof c[0]&&c[1].includes(o.length):s==="mesh"&&o instanceof Float32Array&&i.length===
3&&i[0]===n[0]&&i[1]===n[1]&&o.length===i[0]*i[1]*i[2]))throw new Error(`the part "${s}" of a tile has a wrong size`)}}function Nc(a,{
geometry:e,slices:t},r){let[n,s]=e.shape,[o,{drawn:i,nodes:c}={drawn:[0,0],nodes:[0,0]}]=[a.shape[2],t.trace],l=new Float32Array(
n*s);for(let h=0;h<l.length;h+=1){let u=(Math.floor(h/s)+i[0])*c[1]+h%s+i[1];l[h]=r*Le[Number(a.data[o*(u+1)-1-Number(t.
trace?.uncertain??!1)])]}return{name:"",data:l,shape:[n,s],digest:`${a.digest} speed`}}function Ra(a){let e=Pa(a);return e.
fault==="other"||e.detail!==e.message?e:new $(e.fault,Rc[e.fault],e.message)}var or=class{hasSteps=!0;atOnce=6;memory=18e7;header;told;url;store;headers=new Map;opening=null;constructor(e,t){
let r=e.store;if(!r)throw new Error("the page does not say where its store is");this.header=e,this.told=r,this.url=new URL(
r.url,t),this.store=new sr(this.url.href)}open(){return this.opening??=this.compare().catch(e=>{let t=Ra(e);throw t.fault===
"unreachable"&&(this.opening=null),t}),this.opening}async compare(){let{url:e}=this.told;if(!/^https?:/.test(this.url.protocol)){
let n=`This page reads its store from ${e} in the same folder, which browsers do not allow when the page is opened as a \
file: open it from a web server.`;throw new $("other",n)}let t=(await this.store.attributes()).flowtex;if(Lc.every(n=>t?.[n]===
this.told[n]))return;let r=`The store at ${e} does not match this page: it has another flow, other paths or another vers\
ion: export the page again.`;throw new $("other",r)}load=async(e,t,r,n)=>{let s=e??[this.told.depth,0,0],o=G(s);return this.
loaded(r,async i=>{let c=t.filter(d=>!n(`slices/${d}`)&&!n(`flow/${d}`)),l=e?n("header")&&!c.length?this.headers.get(o):
void 0:this.header,h=l===void 0?this.surface(s,i):{header:l,parts:[]},u=new Map(c.map(d=>[d,this.flow(s,d,i)])),m=[...u.
values()],p=async()=>{let{header:d,parts:g}=await h;if(e&&this.headers.set(o,d),!d)return g;let[b,...y]=await Promise.all(
[this.values(s,d,t,n,i,u),...m]);if(zr(y.flat(),d,this.header.mesh.tileCells),!y.every(x=>x.length))throw new Error(`til\
e ${o} has no flow`);return[...g,...y.flat(),...b]},[f]=await Promise.all([p(),...m]);return e?f.map(d=>({...d,name:`til\
e/${o}/${d.name}`})):f})};async loaded(e,t){let r=new AbortController;e.addEventListener("abort",()=>r.abort(),{once:!0});
try{return await this.open(),e.throwIfAborted(),await t(r.signal)}catch(n){throw e.throwIfAborted(),Ra(n)}finally{r.abort()}}async file(e,t,r,n){
let s=await this.store.array(`${t[0]}/${e}`),o=async f=>{let{data:d}=await s.getChunk([...r,f],{signal:n});if(!(d instanceof
Uint8Array))throw new Error(`${s.path} is empty`);return d},i=await o(0),[c,l]=ur(i),h=c.reduce((f,{bytes:d})=>f+d,l);if(!ve(
h,_c))throw new Error(`a file of ${s.path} has a wrong size`);let u=new Uint8Array(Math.ceil(h/i.length)*i.length);u.set(
i);for(let f=1;f*i.length<h;f+=1)u.set(await o(f),f*i.length);let m=new Map;for(let f of en(u.buffer)){let[d,g]=pe(f.name)??
["",f.name];if(d&&d!==G(t))throw new Error(`in place of tile ${G(t)} is ${d}`);m.set(g,{...f,name:g})}if(new TextDecoder().
decode(m.get("of")?.data)!==this.told.fingerprint)throw new Error(`tile ${G(t)} belongs to another flow`);return m.delete(
"of"),m}async surface(e,t){let r=await this.file("surface",e,[e[1],e[2]],t),n=this.tileHeader(r.get("header"));if(r.delete(
"header"),n){let i=La(n).needed.filter(c=>!r.has(c));if(i.length)throw new Error(`a tile has no ${i.join(", ")}`);zr([...r.
values()],n,this.header.mesh.tileCells)}let s=new TextEncoder().encode(JSON.stringify(n)),o={name:"header",data:s,shape:[
s.length],digest:`${this.told.fingerprint} ${G(e)} header`};return{header:n,parts:[o,...r.values()]}}tileHeader(e){let t=JSON.
parse(new TextDecoder().decode(e?.data));if(t===null)return null;let{steps:r,times:n,timeUnit:s,dates:o,pace:i}=this.header.
slices;return Fc(t,this.header),{...t,slices:{...t.slices,steps:r,times:n,timeUnit:s,dates:o,pace:i}}}async flow(e,t,r){
let n=this.told.steps[t];return[...(await this.file("flow",e,[n,e[1],e[2]],r)).values()].map(o=>{let[i,c]=o.name.split("\
/");if(Number(c)!==n)throw new Error(`in place of step ${n} is ${o.name}`);return{...o,name:`${i}/${t}`}})}async values(e,t,r,n,s,o){
let i=new Map;for(;;){let{name:c,steps:l,number:h}=this.header.scalars,m=(l>1?r:[0]).map(d=>h?`scalars/${d}/${h}`:`scala\
rs/${d}`),p=c===null?[]:m.filter(d=>!n(d)&&!i.has(d));if(!p.length)return[...i.values()];let f=await Promise.all(p.map(async d=>{
let g=l>1?Y(d):0;if(!h&&this.told.derivesSpeed&&t.slices.trace){let[v]=await(o.get(g)??this.flow(e,g,s));return{...Nc(v,
t,this.header.speed.typical),name:d}}let b=l>1?this.told.steps[g]:0,x=(await this.file("values",e,[b,e[1],e[2],h],s)).get(
`scalars/${b}/${h}`);if(!x)throw new Error(`tile ${G(e)} has no values of step ${b}`);return{...x,name:d}}));zr(f,t,this.
header.mesh.tileCells);for(let d of f)i.set(d.name,d)}}};var Ic=4096,Cc=4,ka=32,Uc=.25,Vc=1e4,Oa=class{id;type="custom";renderingMode="2d";options;map=null;gl=null;programs=null;array=null;scene=null;pictures=[];look="";globe=!1;shownOpacity=1;close=null;asked=Promise.
resolve(null);own;colours={};constructor(e){this.options=e,this.own={...e.settings},this.id=e.id}onAdd(e,t){this.onRemove(),
this.map=e,this.gl=t;let r={context:t,counted:n=>n,free:()=>{}};this.programs=new Se(r),this.array=t.createVertexArray(),
this.open(t).catch(n=>this.failed(n.message,""))}onRemove(){let{gl:e}=this;for(let t of this.pictures)t.dispose(e);this.
close?.then(t=>t.dispose()),this.close=null,e?.deleteVertexArray(this.array),this.programs?.dispose(),this.map=this.gl=this.
scene=null,[this.pictures,this.look]=[[],""]}async open(e){let{scene:t,opacity:r}=this.options,n=new URL(typeof t=="stri\
ng"?t:"",location.href).href,{headers:s,parts:o}=typeof t=="string"?await Dc(n):t;if(this.gl!==e)return;let i=Bc(s[0]),c=new Bt(
i,o.flatMap(([f,d,g])=>f?[]:[[d,g]]),new Map,new Map),l=i.store?new or(i,n):c,h={header:i,settings:{...i.settings,...i.own,
...this.own},player:new ut};this.shownOpacity=r??s[0].opacity;let u=async(f,d)=>{let g=!0,b=new Ut(f,{...h,source:l,isComing:()=>g});
d(b);for(let y of c.parts){let x=await c.kept(y);if(b.lifetime.isOver)break;b.setPart(x)}return g=!1,Object.keys(this.colours).
length&&b.chooseColours(this.colours),b},m=()=>{let f=null;return u(this.hostOf(()=>f),d=>this.pictures.push(f=new Dt(e,
d)))},p=await m();this.gl===e&&(this.scene={...h,add:m,make:u,mercator:new Vt(i.earth,p.parts.get("lonlat"),i.ends)},p.requests.
open(),this.options.onOpen?.(),this.map?.triggerRepaint())}hostOf=e=>({isHeld:()=>this.map?.isMoving()??!1,painted:t=>{e()?.
painted(t),this.map?.triggerRepaint()},advanced:()=>this.options.onTime?.(this.time),failed:(t,r)=>this.failed(t,r)});get time(){
let{varies:e=!1,time:t=0,clock:r=0}=this.scene?.player??{};return e?t:r}set time(e){let{player:t}=this.scene??{};t?.varies?
t.seek(e):t&&(t.clock=e),this.change()}get times(){return this.scene?.header.slices.times??[]}get bounds(){let{mercator:e}=this.
scene??{};if(!e)return null;let{box:t}=e;return[e.lngLatOf(t.slice(0,2)),e.lngLatOf(t.slice(2))]}get opacity(){return this.
shownOpacity}set opacity(e){this.shownOpacity=e,this.map?.triggerRepaint()}play(){let{player:e,settings:t}=this.scene??{};
!e||!t||(!e.varies&&t.motion==="off"&&(t.motion="speed"),e.start(),this.change())}pause(){this.scene&&(this.scene.player.
playing=!1),this.change()}set(e){Object.assign(this.own,e),Object.assign(this.scene?.settings??{},e),this.change()}setColours(e){
Object.assign(this.colours,e);for(let{view:t}of this.pictures)t.chooseColours(e)}change(){for(let{view:e}of this.pictures)
e.change()}async pointAt(e){let{mercator:t,header:r}=this.scene??{};if(!t||!r)return null;let n=[...t.positionOf(ge(e)),
r.geometry.center[2]],s=this.pictures.filter(({isUsed:c})=>c).map(({view:c})=>c);await Na(()=>s.every(({painter:c})=>c.canPick&&
c.shown));let o=s.map(c=>this.pointIn(c,n)).find(Boolean)??null;if(o&&!r.pyramid)return o;this.asked=this.asked.then(()=>this.
pointClose(n)).catch(()=>null);let i=await this.asked;return i&&{...i,path:o?.path??i.path}}pointIn(e,t){let{camera:r,parts:n,
settings:s}=e,{mercator:o}=this.scene??{},i=r?.project(t)??[2,2],c=Math.max(...i.map(Math.abs))>1?null:e.find(i[0],i[1]),
l=e.painter.shown;if(!o||!r||!c||!l)return null;let h=c.point.position,u={scene:c.layer.scene,moment:l,place:c.place,position:h},
[m,p]=xs(u,n.get("lonlat"))??[NaN,NaN],{path:f}=fs(u,s,r,e.rows);return{eastward:m,northward:p,values:c.point.values,path:f.
map(d=>o.lngLatOf(d))}}async pointClose(e){let{scene:t}=this;if(!t)return null;let r=!1,n={...this.hostOf(()=>null),painted:()=>{
r=!0},advanced:()=>{}},s=await(this.close??=t.make(n,f=>f.requests.open())),{box:o}=t.mercator,{pyramid:i,geometry:c}=t.
header,l=Uc*(o[2]-o[0])/(i?.shapes[0]??c.shape)[1],[h,u,m]=e,p={up:[0,1,0],view_angle:30,position:[h,u,m+l],focal_point:e,
parallel:!0,parallel_scale:l};return s.isVisible=!0,s.look(p,ka,ka,1),await Na(()=>r&&s.painter.canPick&&!s.tiles?.pending&&
!s.tiles?.missing.length),s.isVisible=!1,this.pointIn(s,e)}failed(e,t){this.map?.fire("error",{error:new Error([e,t].filter(
Boolean).join(" "))})}render(e,t){let{map:r,scene:n,programs:s,array:o,opacity:i}=this;if(!r||!n||!s)return;let c=t.defaultProjectionData.
projectionTransition>0;this.follow(r,n,c);let[l,h]=[r.getZoom(),r.getCenter()],u=this.pictures.filter(({isUsed:d})=>d),{
shaderData:m,getProjectionData:p}=t,f={gl:e,programs:s,array:o,shaderData:m,getProjectionData:p,zoom:l,center:h,globe:c,
opacity:i};for(let d of u){let g=d.draw({...f,mercator:n.mercator,isRepeated:u.length===1});typeof g=="string"&&g?this.failed(
"The flow cannot be drawn on the map.",g):g!==!0&&r.triggerRepaint()}}follow(e,{mercator:t,header:r,add:n},s){let{what:o,
ratio:i,text:c}=Fa(e,s);if(c===this.look)return;let l=t.look(o,r.geometry.center[2]);l.length>this.pictures.length&&n(),
[0,1].forEach(h=>{let{width:u=1,height:m=1}=l[h]??{},p=Math.sqrt(Cc*o.width*o.height/(u*m));this.pictures[h]?.follow(l[h],
Math.min(i,i*p,Ic/Math.max(u,m)))}),this.look=c,this.globe=s}get isComplete(){let{map:e,pictures:t}=this;return!e||!this.
scene||!t.every(r=>r.isComplete)?!1:this.look===Fa(e,this.globe).text}};function Fa(a,e){let{clientWidth:t,clientHeight:r}=a.
getCanvas(),n={center:a.unproject([t/2,r/2]),width:t,height:r,zoom:a.getZoom(),bearing:a.getBearing(),pitch:a.getPitch(),
fov:a.getVerticalFieldOfView(),globe:e},s=a.getPixelRatio();return{what:n,ratio:s,text:JSON.stringify([n,s])}}async function Na(a){
let e=performance.now()+Vc;for(;!a()&&performance.now()<e;)await new Promise(requestAnimationFrame)}async function Dc(a){
let e=await fetch(a);if(!e.ok)throw new Error(`the scene ${a} cannot be read: the server answers ${e.status}`);return await e.
json()}function Bc(a){let{earth:e}=a,t={land:null,coastlines:!1,graticule:!1};return{...a,ends:Hc(a),background:[0,0,0],
opacity:1,earth:e&&{...e,...t}}}function Hc({earth:a,geometry:e,slices:t}){let{map:r}=a??{};if(!a||!r||!e.periodic[1])return null;
let n=.5*(r[0]+r[2]),s=.5*(t.trace?.offset[3]??2*Math.PI*a.radius);return[n-s,n+s]}export{Oa as FlowtexLayer};
